// Bytes of files as UTF-8, which is what everything that is written is in.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace ductile {

/// How many bytes at the text's start are whole characters of UTF-8: all of them, or up to the first that is
/// none (too long, a surrogate, beyond U+10FFFF).
std::size_t valid_utf8(std::string_view text);

/// "line:column" of a byte, both from 1.
std::string line_and_column(std::string_view text, std::size_t offset);

std::string from_windows_1252(std::string_view text);

}  // namespace ductile
