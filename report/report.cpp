#include "ductile/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <fstream>

#include "case.h"
#include "ductile/files.h"
#include "report_page.h"

namespace ductile {
namespace report {

// JSON has no infinity: what is not finite becomes null.
static void to_json(Json& j, const Axis& a) { j = {{"title", a.title}, {"log", a.log}}; }
static void to_json(Json& j, const Series& s) {
  j = {{"name", s.name}, {"look", s.look}, {"x", s.x},           {"y", s.y},      {"low", s.low},
       {"high", s.high}, {"told", s.told}, {"marked", s.marked}, {"line", s.line}};
}
static void to_json(Json& j, const Figure& f) {
  j = {{"name", f.name},   {"group", f.group.empty() ? f.name : f.group},
       {"tab", f.tab},     {"first", f.first},
       {"title", f.title}, {"caption", f.caption},
       {"x", f.x},         {"y", f.y},
       {"floor", f.floor}, {"series", f.series}};
}
static void to_json(Json& j, const Matrix::Cell& c) { j = {{"verdict", c.verdict}, {"told", c.told}}; }
static void to_json(Json& j, const Matrix::Row& r) {
  j = {{"name", r.name}, {"promised", r.promised}, {"cells", r.cells}};
}
static void to_json(Json& j, const Matrix& m) {
  j = {{"name", m.name},     {"title", m.title},     {"caption", m.caption},
       {"levels", m.levels}, {"columns", m.columns}, {"rows", m.rows}};
}
static void to_json(Json& j, const Column& c) { j = {{"name", c.name}, {"measured", c.measured}}; }
static void to_json(Json& j, const Table& t) {
  j = {{"name", t.name}, {"title", t.title}, {"columns", t.columns}, {"rows", t.rows}, {"open", t.open}};
}
static void to_json(Json& j, const Claim& c) {
  j = {{"what", c.what}, {"measured", c.measured}, {"holds", c.holds}, {"by_clock", c.by_clock}};
}

namespace {

const Case* const cases[] = {&benchmarks, &joints,   &peers,       &sections,    &discretisation,
                             &stability,  &extremes, &interaction, &leaving_out, &growth};

std::string csv(const Json& table) {
  const auto cell = [](const Json& value) {
    if (value.is_null()) return std::string();
    if (!value.is_string()) return value.dump();
    std::string text = value.get<std::string>();
    if (text.find_first_of(",\"\n") == std::string::npos) return text;
    for (std::size_t i = 0; (i = text.find('"', i)) != std::string::npos; i += 2) text.insert(i, 1, '"');
    return '"' + text + '"';
  };
  std::string text;
  const auto line = [&](const Json& row, auto&& value) {
    std::string cells;
    for (const Json& item : row) cells += (cells.empty() ? "" : ",") + cell(value(item));
    text += cells + "\n";
  };
  line(table["columns"], [](const Json& c) { return c["name"]; });
  for (const Json& row : table["rows"]) line(row, [](const Json& c) { return c; });
  return text;
}

/// FNV-1a of this very program: data of another one are not kept.
std::string build_id() {
  std::uint64_t hash = 0xcbf29ce484222325;
  std::ifstream self("/proc/self/exe", std::ios::binary);
  std::vector<char> block(1 << 16);
  while (self.read(block.data(), static_cast<std::streamsize>(block.size())), self.gcount() > 0) {
    for (std::streamsize i = 0; i < self.gcount(); ++i) {
      hash = (hash ^ static_cast<unsigned char>(block[static_cast<std::size_t>(i)])) * 0x100000001b3;
    }
  }
  return fmt::format("{:016x}", hash);
}

/// The first value of a key in a file of "key : value" lines.
std::string value_in(const char* file, const std::string& key) {
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    if (!line.starts_with(key)) continue;
    const std::size_t at = line.find_first_of(":=");
    if (at == std::string::npos) continue;
    line.erase(0, at + 1);
    std::erase(line, '"');
    return line.substr(std::min(line.size(), line.find_first_not_of(" \t")));
  }
  return "unknown";
}

Json machine() {
  return {{"processor", value_in("/proc/cpuinfo", "model name")},
          {"system", value_in("/etc/os-release", "PRETTY_NAME")},
          {"compiler", DUCTILE_COMPILER},
          {"flags", DUCTILE_FLAGS},
          {"Box2D", DUCTILE_BOX2D},
          {"ductile", DUCTILE_VERSION}};
}

/// The data of an earlier run, when they are complete and of this program; null otherwise.
Json kept(const std::filesystem::path& file, const Json& made_by) {
  if (!std::filesystem::exists(file)) return nullptr;
  const Json data = Json::parse(read_text(file), nullptr, false);
  return data.is_object() && data.value("made_by", Json()) == made_by ? data : nullptr;
}

Json run(const Case& c, const ReportOptions& options, const Json& made_by) {
  const auto start = std::chrono::steady_clock::now();
  const Result r = c.run({options.quick, [&](double share) {
                            if (options.progress) options.progress(c.name, share);
                          }});
  const double took = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return {{"name", c.name},
          {"title", c.title},
          {"made_by", made_by},
          {"machine", machine()},
          {"seconds", std::round(10 * took) / 10},
          {"summary", r.summary},
          {"text", r.text},
          {"claims", r.claims},
          {"figures", r.figures},
          {"matrices", r.matrices},
          {"tables", r.tables}};
}

void put(std::string& page, std::string_view mark, const std::string& text) {
  page.replace(page.find(mark), mark.size(), text);
}

/// JSON that may stand in a script element.
std::string for_script(const Json& json) {
  std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  for (std::size_t at = 0; (at = text.find("</", at)) != std::string::npos; at += 3)
    text.insert(at + 1, 1, '\\');
  return text;
}

}  // namespace
}  // namespace report

std::vector<std::string> report_cases() {
  std::vector<std::string> names;
  for (const report::Case* c : report::cases) names.emplace_back(c->name);
  return names;
}

std::string make_report(const ReportOptions& options) {
  using report::Json;
  const std::filesystem::path data = options.out / "data";
  std::filesystem::create_directories(data);
  const Json made_by{{"program", report::build_id()}, {"quick", options.quick}};
  Json all = Json::array();
  std::string said;
  for (const report::Case* c : report::cases) {
    if (!options.only.empty() && options.only != c->name) continue;
    const auto file = data / (std::string(c->name) + ".json");
    Json made = report::kept(file, made_by);
    if (made.is_null()) {
      made = report::run(*c, options, made_by);
      for (const Json& table : made["tables"]) {
        write_text(data / fmt::format("{}-{}.csv", c->name, table["name"].get<std::string>()),
                   report::csv(table));
      }
      write_text(file, made.dump() + "\n");  // last: it says that the case is complete
    }
    said += fmt::format("{} ({} s)\n", c->title, made["seconds"].get<double>());
    for (const Json& claim : made["claims"]) {
      said += fmt::format("  {:<7}{}: {}\n", claim["holds"] ? "holds" : "MISSED",
                          claim["what"].get<std::string>(), claim["measured"].get<std::string>());
    }
    all.push_back(std::move(made));
  }
  std::string page(report_page);
  report::put(page, "@PLOTLY@", options.plotly);
  report::put(page, "@DATA@", report::for_script({{"quick", options.quick}, {"cases", all}}));
  write_text(options.out / "index.html", page);
  return said;
}

}  // namespace ductile
