#include "utf8.h"

#include <algorithm>
#include <array>

namespace ductile {

std::size_t valid_utf8(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  std::size_t at = 0;
  while (at < text.size()) {
    const unsigned first = byte(at);
    const std::size_t size = first < 0x80                     ? 1
                             : first >= 0xC2 && first <= 0xDF ? 2
                             : first >= 0xE0 && first <= 0xEF ? 3
                             : first >= 0xF0 && first <= 0xF4 ? 4
                                                              : 0;
    if (size == 0 || size > text.size() - at) return at;
    for (std::size_t i = 1; i < size; ++i)
      if ((byte(at + i) & 0xC0) != 0x80) return at;
    if (size > 2) {
      const unsigned second = byte(at + 1);
      const bool too_long = (first == 0xE0 && second < 0xA0) || (first == 0xF0 && second < 0x90);
      const bool surrogate = first == 0xED && second > 0x9F, beyond = first == 0xF4 && second > 0x8F;
      if (too_long || surrogate || beyond) return at;
    }
    at += size;
  }
  return at;
}

std::string line_and_column(std::string_view text, std::size_t offset) {
  const std::string_view before = text.substr(0, std::min(offset, text.size()));
  const auto line = std::count(before.begin(), before.end(), '\n') + 1;
  const auto start = before.rfind('\n');
  return std::to_string(line) + ":" +
         std::to_string(before.size() - (start == std::string_view::npos ? 0 : start + 1) + 1);
}

std::string from_windows_1252(std::string_view text) {
  // Of 0x80 to 0x9F, as the WHATWG's encoding standard has them; beyond, a byte is its own code point.
  constexpr std::array<unsigned, 32> own{0x20AC, 0x81,   0x201A, 0x192,  0x201E, 0x2026, 0x2020, 0x2021,
                                         0x2C6,  0x2030, 0x160,  0x2039, 0x152,  0x8D,   0x17D,  0x8F,
                                         0x90,   0x2018, 0x2019, 0x201C, 0x201D, 0x2022, 0x2013, 0x2014,
                                         0x2DC,  0x2122, 0x161,  0x203A, 0x153,  0x9D,   0x17E,  0x178};
  std::string result;
  result.reserve(text.size());
  for (const char c : text) {
    const unsigned byte = static_cast<unsigned char>(c);
    const unsigned point = byte >= 0x80 && byte < 0xA0 ? own[byte - 0x80] : byte;
    if (point < 0x80) {
      result += c;
      continue;
    }
    if (point < 0x800) {
      result += static_cast<char>(0xC0 | point >> 6);
    } else {
      result += static_cast<char>(0xE0 | point >> 12);
      result += static_cast<char>(0x80 | (point >> 6 & 0x3F));
    }
    result += static_cast<char>(0x80 | (point & 0x3F));
  }
  return result;
}

}  // namespace ductile
