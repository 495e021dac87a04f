#include "hand.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "pick.h"

namespace ductile::viewer {
namespace {

/// One significant digit.
double round_number(double value) {
  if (!(value > 0) || !std::isfinite(value)) return 1;
  const double unit = std::pow(10, std::floor(std::log10(value)));
  return std::round(value / unit) * unit;
}

/// What can be moved there.
std::optional<act::Grab> grab_at(const Workbench& bench, Point at) {
  if (const auto thrown = thrown_at(bench.run(), at)) {
    return act::Grab{.thrown = static_cast<int>(*thrown)};
  }
  const auto piece = piece_at(bench.plan(), bench.frame(), at);
  if (!piece) return std::nullopt;
  const auto body = static_cast<std::size_t>(bench.plan().pieces[*piece].body);
  if (bench.plan().bodies[body].type != BodyType::dynamic_body) return std::nullopt;
  return act::Grab{.piece = static_cast<int>(*piece)};
}

}  // namespace

Hand::Throwing Hand::suited(const Plan& plan) {
  double moving = 0;
  for (const Piece& piece : plan.pieces) moving += piece.mass;
  const Point box = extent(plan).size();
  const double length = std::max(box.x, box.y);
  // Twice what a fall over the whole scene ends with, on earth where there is no gravity.
  const double g = ductile::length(plan.gravity);
  return {.mass = round_number(0.1 * moving),
          .size = round_number(0.05 * length),
          .speed = round_number(2 * std::sqrt(2 * (g > 0 ? g : 9.81) * length))};
}

void Hand::suit(const Plan& plan, bool edited) {
  const Throwing now = suited(plan);
  if (!edited || mass == suited_.mass) mass = now.mass;
  if (!edited || size == suited_.size) size = now.size;
  if (!edited || speed == suited_.speed) speed = now.speed;
  suited_ = now;
}

void Hand::press(const Camera& camera, Point px, Keys keys) {
  from_ = now_ = camera.to_world(px);
  keys_ = keys;
  doing_ = Doing::pressing;
}

void Hand::move(Workbench& bench, const Camera& camera, Point px) {
  const Point before = now_;
  now_ = camera.to_world(px);
  constexpr double still = 4;  // px
  if (doing_ == Doing::pressing && length(now_ - from_) * camera.scale > still * ui_scale) {
    if (keys_.shift) {
      doing_ = Doing::aiming;
    } else if (const auto grab = keys_.ctrl ? std::nullopt : grab_at(bench, from_)) {
      doing_ = Doing::dragging;
      bench.act(act::Grab{grab->piece, grab->thrown, from_, strength});
    } else {
      doing_ = Doing::boxing;
    }
  }
  if (doing_ == Doing::dragging && now_ != before) bench.act(act::Pull{now_});
}

void Hand::release(Workbench& bench, const Camera& camera, Point px) {
  move(bench, camera, px);
  const Doing done = doing_;
  doing_ = Doing::nothing;
  switch (done) {
    case Doing::nothing:
      break;
    case Doing::pressing:
      if (const auto joint = joint_at(bench.plan(), bench.frame(), now_, reach * ui_scale / camera.scale)) {
        bench.select({*joint}, keys_.shift);
      } else if (const auto piece = piece_at(bench.plan(), bench.frame(), now_)) {
        bench.body = static_cast<std::size_t>(bench.plan().pieces[*piece].body);
      } else if (!keys_.shift) {
        bench.select({}, false);
      }
      break;
    case Doing::dragging:
      bench.act(act::Release{});
      break;
    case Doing::boxing: {
      Bounds box;
      box.add(from_);
      box.add(now_);
      bench.select(joints_in(bench.plan(), bench.frame(), box), keys_.shift);
      break;
    }
    case Doing::aiming: {  // as far as it was pulled back, in a quarter of a second
      const Point velocity = 4 * (from_ - now_);
      bench.act(act::Throw{.at = from_, .velocity = velocity, .mass = mass, .size = size});
      break;
    }
  }
}

void Hand::throw_at(Workbench& bench, const Camera& camera, Point target) const {
  const double away = 0.5 * camera.screen.size().y / camera.scale;
  const double s = std::sqrt(0.5);
  bench.act(act::Throw{
      .at = target + away * Point{-s, s}, .velocity = speed * Point{s, -s}, .mass = mass, .size = size});
}

void Hand::put(Workbench& bench, Point at) const {
  bench.act(act::Throw{.at = at, .velocity = {0, 0}, .mass = mass, .size = size, .square = true});
}

}  // namespace ductile::viewer
