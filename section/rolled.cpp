#include "ductile/rolled.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <numbers>
#include <span>
#include <utility>

#include "rolled_tables.h"

namespace ductile {
namespace {

using profiles::Dimensions;

struct Family {
  std::string_view prefix;
  Shape shape;
  std::span<const Dimensions> table;  // empty: of any size
  std::string_view written;           // an example
};
constexpr std::array families{
    Family{"IPE", Shape::i_section, profiles::i_sections, "IPE 300"},
    Family{"HEA", Shape::i_section, profiles::i_sections, "HEA 200"},
    Family{"HEB", Shape::i_section, profiles::i_sections, "HEB 200"},
    Family{"HEM", Shape::i_section, profiles::i_sections, "HEM 200"},
    Family{"UB", Shape::i_section, profiles::i_sections, "UB 533x210x92"},
    Family{"UC", Shape::i_section, profiles::i_sections, "UC 203x203x46"},
    Family{"PFC", Shape::channel, profiles::channels, "PFC 230x75x26"},
    Family{"UPE", Shape::channel, profiles::channels, "UPE 200"},
    Family{"UPN", Shape::channel, profiles::tapered_channels, "UPN 200"},
    Family{"L", Shape::angle, profiles::angles, "L 100x100x10"},
    Family{"CHS", Shape::round_tube, {}, "CHS 168.3x5"},
    Family{"RHS", Shape::rectangular_tube, {}, "RHS 200x100x5"},
    Family{"SHS", Shape::rectangular_tube, {}, "SHS 100x5"},
};

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Upper case, without blanks, x for ×; as the tables have it what EN 10365 calls HE 200 A and DIN 1026-1 U
/// 200.
std::string plain(std::string_view name) {
  std::string letters;
  for (std::size_t i = 0; i < name.size(); ++i) {
    const auto c = static_cast<unsigned char>(name[i]);
    if (c == 0xc3 && i + 1 < name.size() && static_cast<unsigned char>(name[i + 1]) == 0x97) {
      letters += 'x';
      ++i;
    } else if (c == 'x' || c == 'X') {
      letters += 'x';
    } else if (!std::isspace(c)) {
      letters += static_cast<char>(std::toupper(c));
    }
  }
  if (letters.size() > 1 && letters[0] == 'U' && is_digit(letters[1])) return "UPN" + letters.substr(1);
  if (letters.size() > 3 && letters.starts_with("HE") && is_digit(letters[2]) && !is_digit(letters.back()))
    return "HE" + letters.substr(letters.size() - 1) + letters.substr(2, letters.size() - 3);
  return letters;
}

const Family* family_of(std::string_view plain_name) {
  const auto letters = std::min(plain_name.find_first_of("0123456789"), plain_name.size());
  const auto found = std::find_if(families.begin(), families.end(), [&](const Family& family) {
    return family.prefix == plain_name.substr(0, letters);
  });
  return found == families.end() || letters == plain_name.size() ? nullptr : &*found;
}

/// The numbers between the x's, m; empty where one is none.
std::vector<double> sizes(std::string_view text) {
  std::vector<double> values;
  for (;;) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{}) return {};
    values.push_back(value / 1000);
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    if (text.empty()) return values;
    if (text.front() != 'x') return {};
    text.remove_prefix(1);
  }
}

Rolled from_table(const Dimensions& row, Shape shape) {
  Rolled profile{.name = row.name, .shape = shape, .h = row.h / 1000, .b = row.b / 1000};
  if (shape == Shape::angle) {
    profile.tw = profile.tf = row.tw / 1000;
    profile.r = row.tf / 1000;
    profile.toe = row.r / 1000;
  } else if (profile.name.starts_with("UPN")) {
    const bool low = row.h <= 300;
    profile.tw = row.tw / 1000;
    profile.tf = profile.r = row.tf / 1000;
    profile.toe = row.r / 1000;
    profile.slope = low ? 0.08 : 0.05;
    profile.u = (low ? profile.b : profile.b - profile.tw) / 2;
  } else {
    profile.tw = row.tw / 1000;
    profile.tf = row.tf / 1000;
    profile.r = row.r / 1000;
  }
  return profile;
}

[[noreturn]] void unknown(std::string_view name, const std::string& remedy) {
  throw InvalidInput({{"profile '" + std::string(name) + "'", "is in no table", remedy}});
}

/// CHS D x t, RHS H x B x t, SHS B x t or B x B x t.
Rolled tube(const Family& family, std::string_view name, std::string_view plain_name) {
  std::vector<double> size = sizes(plain_name.substr(family.prefix.size()));
  const bool round = family.shape == Shape::round_tube;
  if (family.prefix == "SHS" && size.size() == 3 && size[0] == size[1]) size.erase(size.begin());
  if (size.size() != (family.prefix == "RHS" ? 3u : 2u))
    unknown(name, "write its outer dimensions and its wall in mm: " + std::string(family.written));
  const double t = size.back();
  std::string written = std::string(family.prefix) + " " + std::string(plain_name.substr(3));
  return {.name = std::move(written),
          .shape = family.shape,
          .h = size[0],
          .b = size.size() == 3 ? size[1] : size[0],
          .tw = t,
          .tf = t,
          .r = round ? 0 : t,
          .toe = round ? 0 : 1.5 * t};
}

}  // namespace

bool names_a_profile(std::string_view name) {
  const std::string letters = plain(name);
  const std::size_t digits = std::min(letters.find_first_of("0123456789"), letters.size());
  if (digits == 0 || digits > 3 || digits == letters.size()) return false;
  for (std::size_t i = 0; i < letters.size(); ++i) {
    const bool is_point = letters[i] == '.' && i + 1 < letters.size() && is_digit(letters[i + 1]);
    if (!is_point && std::isalnum(static_cast<unsigned char>(letters[i])) == 0) return false;
  }
  return true;
}

Rolled rolled(std::string_view name) {
  const std::string wanted = plain(name);
  const Family* family = family_of(wanted);
  if (!family) {
    std::string known;
    for (const Family& f : families) known += (known.empty() ? "" : ", ") + std::string(f.written);
    unknown(name, "profiles are written as in " + known);
  }
  if (family->table.empty()) {
    Rolled profile = tube(*family, name, wanted);
    draw(profile);  // throws where its dimensions make none
    return profile;
  }
  std::string sizes;
  for (const Dimensions& row : family->table) {
    const std::string known = plain(row.name);
    if (known == wanted) return from_table(row, family->shape);
    if (known.starts_with(family->prefix) && is_digit(known[family->prefix.size()]))
      sizes += " " + known.substr(family->prefix.size());
  }
  unknown(name, "there are " + std::string(family->prefix) + sizes);
}

std::vector<Rolled> rolled_profiles() {
  std::vector<Rolled> all;
  for (const Dimensions& row : profiles::i_sections) all.push_back(from_table(row, Shape::i_section));
  for (const Dimensions& row : profiles::channels) all.push_back(from_table(row, Shape::channel));
  for (const Dimensions& row : profiles::tapered_channels) all.push_back(from_table(row, Shape::channel));
  for (const Dimensions& row : profiles::angles) all.push_back(from_table(row, Shape::angle));
  return all;
}

Profile draw(const Rolled& p, double tolerance) {
  switch (p.shape) {
    case Shape::i_section:
      return profiles::i_section(p.h, p.b, p.tw, p.tf, p.r, tolerance);
    case Shape::channel:
      return p.slope == 0
                 ? profiles::channel(p.h, p.b, p.tw, p.tf, p.r, tolerance)
                 : profiles::tapered_channel(p.h, p.b, p.tw, p.tf, p.slope, p.u, p.r, p.toe, tolerance);
    case Shape::angle:
      return profiles::angle(p.h, p.b, p.tw, p.r, p.toe, tolerance);
    case Shape::round_tube:
      return profiles::tube(p.h, p.tw, tolerance);
    case Shape::rectangular_tube:
      break;
  }
  return profiles::hollow(p.b, p.h, p.tw, p.toe, p.r, tolerance);
}

}  // namespace ductile
