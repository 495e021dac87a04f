#include "json_text.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <string>

#include "json.h"

namespace ductile {

/// Behind spaces and comments.
std::size_t JsonText::skip_space(std::size_t at) const {
  for (;;) {
    at = std::min(text_.find_first_not_of(" \t\r\n", at), text_.size());
    if (text_.compare(at, 2, "//") == 0)
      at = std::min(text_.find('\n', at), text_.size());
    else if (text_.compare(at, 2, "/*") == 0)
      at = std::min(text_.find("*/", at + 2), text_.size() - 2) + 2;
    else
      return at;
  }
}

std::size_t JsonText::skip_string(std::size_t at) const {
  for (++at; text_[at] != '"'; ++at)
    if (text_[at] == '\\') ++at;
  return at + 1;
}

std::size_t JsonText::skip_value(std::size_t at) const {
  if (text_[at] == '"') return skip_string(at);
  if (text_[at] == '{' || text_[at] == '[') return container(at).close + 1;
  return std::min(text_.find_first_of(" \t\r\n,]}/", at), text_.size());
}

JsonText::Container JsonText::container(std::size_t at) const {
  Container result{.open = at, .close = 0, .entries = {}};
  const bool object = text_[at] == '{';
  for (at = skip_space(at + 1); text_[at] != '}' && text_[at] != ']'; at = skip_space(at)) {
    if (text_[at] == ',') {
      ++at;
      continue;
    }
    Entry entry{.key = {}, .begin = at, .value = at, .end = 0};
    if (object) {
      const std::size_t end = skip_string(at);
      entry.key = Json::parse(text_.substr(at, end - at)).get<std::string>();
      entry.value = skip_space(skip_space(end) + 1);  // behind the colon
    }
    at = entry.end = skip_value(entry.value);
    result.entries.push_back(std::move(entry));
  }
  result.close = at;
  return result;
}

/// Its `end` is 0 where there is no such member.
JsonText::Entry JsonText::find(const Path& path) const {
  if (path.empty()) {
    const std::size_t at = skip_space(0);
    return {.key = {}, .begin = at, .value = at, .end = skip_value(at)};
  }
  const Entry parent = find(path.parent_pointer());
  const Container of = container(parent.value);
  if (text_[of.open] == '[') return of.entries.at(std::stoul(path.back()));
  const auto found = std::find_if(of.entries.begin(), of.entries.end(),
                                  [&](const Entry& e) { return e.key == path.back(); });
  return found == of.entries.end() ? Entry{} : *found;
}

/// As the last entry, on a line of its own where the others have that.
void JsonText::add(std::size_t at, const std::string& entry) {
  const Container of = container(at);
  if (of.entries.empty()) {
    text_.insert(of.open + 1, entry);
    return;
  }
  const Entry& last = of.entries.back();
  const std::size_t line = text_.rfind('\n', last.begin);
  const bool own_line =
      line != std::string::npos && line > of.open && text_.find_first_not_of(" \t", line + 1) == last.begin;
  text_.insert(last.end, "," + (own_line ? text_.substr(line, last.begin - line) : " ") + entry);
}

void JsonText::set(const Path& path, const Json& value) {
  const Entry entry = find(path);
  if (entry.end > 0)
    text_.replace(entry.value, entry.end - entry.value, value.dump());
  else
    add(find(path.parent_pointer()).value, Json(path.back()).dump() + ": " + value.dump());
}

void JsonText::append(const Path& array, const Json& value) { add(find(array).value, value.dump()); }

void JsonText::erase(const Path& path) {
  const Container of = container(find(path.parent_pointer()).value);
  const std::size_t begin = find(path).begin;
  const auto entry = std::find_if(of.entries.begin(), of.entries.end(),
                                  [&](const Entry& e) { return e.begin == begin && e.end > 0; });
  if (entry == of.entries.end()) return;
  const auto next = entry + 1;
  if (entry != of.entries.begin())  // with the comma before it
    text_.erase(std::prev(entry)->end, entry->end - std::prev(entry)->end);
  else
    text_.erase(entry->begin, (next == of.entries.end() ? entry->end : next->begin) - entry->begin);
}

}  // namespace ductile
