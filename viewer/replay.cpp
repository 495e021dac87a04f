#include "ductile/replay.h"

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "ductile/colours.h"
#include "frame.h"
#include "pick.h"
#include "replay_page.h"

namespace ductile {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array piece_channels{"x", "y", "angle"};
constexpr std::array joint_channels{"N",     "Q",        "M",           "usageN", "usageQ",    "usageM",
                                    "stage", "rotation", "accumulated", "used",   "dissipated"};
constexpr double stage_of_broken = 3;

/// Without the mantissa bits that no reader of the page can see: what is left packs much better.
float rounded(double value, int bits) {
  const auto wide = static_cast<float>(value);
  if (!std::isfinite(wide)) return std::isnan(wide) ? std::nanf("") : wide;
  const std::uint32_t drop = 23u - static_cast<std::uint32_t>(bits);
  const std::uint32_t half = (std::uint32_t{1} << drop) >> 1, mask = ~((std::uint32_t{1} << drop) - 1);
  const float out = std::bit_cast<float>((std::bit_cast<std::uint32_t>(wide) + half) & mask);
  return std::isfinite(out) ? out : wide;
}

Json json(Point p) { return {p.x, p.y}; }
/// x, y, x, y … about a centre.
Json flat(const Ring& ring, Point centre) {
  Json list = Json::array();
  for (const Point& p : ring) {
    list.push_back(rounded(p.x - centre.x, 20));
    list.push_back(rounded(p.y - centre.y, 20));
  }
  return list;
}

Json pieces(const Plan& plan) {
  Json list = Json::array();
  for (const Piece& piece : plan.pieces) {
    Json rings = Json::array();
    if (!piece.outline.outer.empty()) rings.push_back(flat(piece.outline.outer, piece.center));
    for (const Ring& hole : piece.outline.holes) rings.push_back(flat(hole, piece.center));
    const bool fixed = plan.bodies[static_cast<std::size_t>(piece.body)].type != BodyType::dynamic_body;
    list.push_back({{"name", piece.name},
                    {"center", json(piece.center)},
                    {"circle", piece.circle},
                    {"fixed", fixed},
                    {"rings", std::move(rings)}});
  }
  return list;
}

Json joints(const Plan& plan) {
  Json list = Json::array();
  for (const PlannedJoint& joint : plan.joints) {
    list.push_back({{"name", joint.name},
                    {"a", joint.a},
                    {"b", joint.b},
                    {"anchor", json(joint.anchor)},
                    {"axis", json(joint.axis)},
                    {"height", joint.height}});
  }
  return list;
}

Json events(const Simulation& simulation) {
  constexpr std::array modes{"tension", "compression", "shear", "rotation"};
  Json list = Json::array();
  for (const SceneEvent& event : simulation.events()) {
    list.push_back({{"time", event.time},
                    {"joint", event.joint},
                    {"kind", event.kind == JointEvent::broke ? "breaks" : "yields"},
                    {"mode", modes[static_cast<std::size_t>(event.mode)]}});
  }
  return list;
}

Json colours() {
  Json list = Json::array();
  for (const ColourStop& stop : stage_colours) {
    list.push_back({{"stage", stop.stage}, {"rgb", {stop.colour.red, stop.colour.green, stop.colour.blue}}});
  }
  return list;
}

/// Text that stands inside a <script> element: nothing in it may look like markup.
std::string for_script(const Json& json) {
  const std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  std::string safe;
  safe.reserve(text.size());
  for (const char c : text) {
    if (c == '<') {
      safe += "\\u003c";
    } else {
      safe += c;
    }
  }
  return safe;
}

std::string base64(std::string_view bytes) {
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      group = group << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += i + k <= bytes.size() ? digits[group >> (18 - 6 * k) & 63] : '=';
    }
  }
  return text;
}

/// Bytes of equal significance side by side, then zlib.
std::string packed(const std::vector<float>& numbers) {
  const std::size_t n = numbers.size();
  std::string planes(4 * n, '\0');
  for (std::size_t i = 0; i < n; ++i) {
    const auto bits = std::bit_cast<std::uint32_t>(numbers[i]);
    for (std::size_t k = 0; k < 4; ++k) planes[k * n + i] = static_cast<char>(bits >> (8 * k) & 255);
  }
  uLongf size = compressBound(static_cast<uLong>(planes.size()));
  std::string out(size, '\0');
  if (compress2(reinterpret_cast<Bytef*>(out.data()), &size, reinterpret_cast<const Bytef*>(planes.data()),
                static_cast<uLong>(planes.size()), Z_DEFAULT_COMPRESSION) != Z_OK) {
    throw std::runtime_error("the replay could not be packed");
  }
  out.resize(size);
  return out;
}

// What the page shows at first: where things were at the start, and where they went within half of that size.
Bounds seen(const Plan& plan, const std::vector<std::vector<float>>& frames) {
  const Bounds start = viewer::extent(plan);
  Bounds box = start;
  const double reach = 0.5 * std::max(start.size().x, start.size().y);
  for (const auto& frame : frames) {
    for (std::size_t i = 0; i < plan.pieces.size(); ++i) {
      if (plan.bodies[static_cast<std::size_t>(plan.pieces[i].body)].type != BodyType::dynamic_body) continue;
      box.add({std::clamp(double{frame[3 * i]}, start.low.x - reach, start.high.x + reach),
               std::clamp(double{frame[3 * i + 1]}, start.low.y - reach, start.high.y + reach)});
    }
  }
  return box;
}

/// What all but a fiftieth of the values keep below: the largest ones are impacts.
double large(std::vector<double>& values) {
  if (values.empty()) return 0;
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(values.size() - 1 - values.size() / 50);
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

void put(std::string& page, std::string_view mark, const std::string& text) {
  page.replace(page.find(mark), mark.size(), text);
}

}  // namespace

Replay::Replay(const Plan& plan, std::size_t most_values)
    : width_(piece_channels.size() * plan.pieces.size() + joint_channels.size() * plan.joints.size()),
      most_frames_(std::max<std::size_t>(16, most_values / std::max<std::size_t>(1, width_))) {}

void Replay::take(const Simulation& simulation) {
  if (taken_++ % stride_ != 0) return;
  constexpr int pose_bits = 19, joint_bits = 12;
  std::vector<float> numbers;
  numbers.reserve(width_);
  const std::size_t pieces = simulation.plan().pieces.size(), joints = simulation.plan().joints.size();
  for (std::size_t i = 0; i < pieces; ++i) {
    const PieceReading p = simulation.piece(i);
    for (const double value : {p.position.x, p.position.y, p.angle}) {
      numbers.push_back(rounded(value, pose_bits));
    }
  }
  for (std::size_t i = 0; i < joints; ++i) {
    const JointReading j = simulation.joint(i);
    for (const double value :
         {j.N, j.Q, j.M, j.usage.N, j.usage.Q, j.usage.M, j.broken ? stage_of_broken : stage(j),
          j.plastic_rotation, j.accumulated_rotation, j.capacity_used, j.dissipated}) {
      numbers.push_back(rounded(value, joint_bits));
    }
  }
  times_.push_back(simulation.time());
  frames_.push_back(std::move(numbers));
  if (frames_.size() > most_frames_) thin();
}

void Replay::thin() {
  std::size_t kept = 1;
  for (std::size_t i = 2; i < frames_.size(); i += 2, ++kept) {
    frames_[kept] = std::move(frames_[i]);
    times_[kept] = times_[i];
  }
  frames_.resize(kept);
  times_.resize(kept);
  stride_ *= 2;
}

std::string Replay::page(const std::string& title, const Simulation& simulation) const {
  const Plan& plan = simulation.plan();
  const std::size_t pieces_end = piece_channels.size() * plan.pieces.size();
  // [frame][item][channel] → [channel][item][frame]: what changes little from one to the next lies together.
  std::vector<float> numbers;
  numbers.reserve(width_ * frames_.size());
  const auto lay_out = [&](std::size_t from, std::size_t items, std::size_t channels) {
    for (std::size_t c = 0; c < channels; ++c) {
      for (std::size_t i = 0; i < items; ++i) {
        for (const auto& frame : frames_) numbers.push_back(frame[from + i * channels + c]);
      }
    }
  };
  lay_out(0, plan.pieces.size(), piece_channels.size());
  lay_out(pieces_end, plan.joints.size(), joint_channels.size());

  std::vector<double> forces, moments;
  for (const auto& frame : frames_) {
    for (std::size_t i = pieces_end; i < frame.size(); i += joint_channels.size()) {
      forces.push_back(std::hypot(double{frame[i]}, double{frame[i + 1]}));
      moments.push_back(std::abs(double{frame[i + 2]}));
    }
  }
  const Bounds box = seen(plan, frames_);
  constexpr std::array solvers{"direct solver", "iterative solver", "stock joints"};
  const Json meta{{"title", title},
                  {"solver", solvers[static_cast<std::size_t>(simulation.solver())]},
                  {"steps", simulation.steps()},
                  {"time", times_},
                  {"extent", {box.low.x, box.low.y, box.high.x, box.high.y}},
                  {"largeForce", large(forces)},
                  {"largeMoment", large(moments)},
                  {"colours", colours()},
                  {"pieceChannels", piece_channels},
                  {"jointChannels", joint_channels},
                  {"pieces", pieces(plan)},
                  {"joints", joints(plan)},
                  {"events", events(simulation)}};
  std::string page(replay_page);
  put(page, "@DATA@", base64(packed(numbers)));  // first: there is no mark in it
  put(page, "@META@", for_script(meta));
  return page;
}

}  // namespace ductile
