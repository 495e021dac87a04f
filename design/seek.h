// How a target is reached: by trying numbers.
#pragma once

#include <functional>
#include <string>

#include "ductile/design.h"

namespace ductile {

/// The factor x with result(x) = target, within 1e-10 of it, of a result that goes about as a power of x: up
/// where `power` > 0, down where it is below, else the other way, as where depth is dead mass. Throws
/// InvalidInput, with `why_not`, where none is found between 1e-12 and 1e12.
double factor_for(double target, const std::function<double(double)>& result,
                  const std::function<std::string()>& why_not, double power = 1);

/// "M of wall-beam/0": the joint that yields first, and its row that is used most.
std::string governing(const Plan& plan, const StaticCheck& check);

}  // namespace ductile
