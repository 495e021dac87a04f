// The fields of definitions and joints, one table per type: the key that files use, the member, the numbers
// that it may hold, and its unit.
//
// Readers and writers of files, calibrate()'s own checks and the schema's test visit these tables: a new
// field is a member and a line here, a line of docs/scene.schema.json, and what it does. What is more than a
// number, a flag, a name or a point (outlines, splits, elasticity, hinge length) is in no table.
#pragma once

#include <limits>
#include <optional>
#include <tuple>

#include "ductile/calibrate.h"

namespace ductile::fields {

/// The numbers that a field may hold.
struct Range {
  double low = std::numeric_limits<double>::lowest();
  bool open = false;             ///< `low` itself is not in it.
  std::optional<double> null{};  ///< What null stands for in a file; unset: null is an error.
  const char* words = "a finite number";

  constexpr bool contains(double value) const {
    return (open ? value > low : value >= low) && value < unlimited;  // false for NaN
  }
};
inline constexpr Range any_number{};
inline constexpr Range positive{0, true, {}, "a number > 0"};
inline constexpr Range not_negative{0, false, {}, "a number >= 0"};
inline constexpr Range limit{0, false, unlimited, "a number >= 0"};
inline constexpr Range spring{0, true, unlimited, "a number > 0"};  ///< null: rigid, or unlimited

/// One field of an `Owner`, whose default is that of Owner{}.
template <class Owner, class T>
struct Field {
  const char* key;
  T Owner::*member;
  Range range{};
  const char* unit = "";
  bool required = false;  ///< Files must have it.
};
template <class Owner, class T, class... Rest>
Field(const char*, T Owner::*, Rest...) -> Field<Owner, T>;

/// Calls `visit(field)` for each field of a table, in its order.
template <class... Fields, class Visit>
constexpr void for_each(const std::tuple<Fields...>& table, Visit&& visit) {
  std::apply([&](const Fields&... field) { (visit(field), ...); }, table);
}

/// What a section needs of a material; `criterion` besides.
inline constexpr std::tuple strength{
    Field{"fy", &Material::yield_stress, positive, "Pa", true},
    Field{"fyc", &Material::yield_stress_compression, positive, "Pa"},
    Field{"tau", &Material::shear_yield_stress, Range{0, true, 0, "a number > 0"}, "Pa"},
    Field{"E", &Material::youngs_modulus, positive, "Pa"}};

/// What bodies and joints need of a material besides.
inline constexpr std::tuple substance{
    Field{"density", &Material::density, positive, "kg/m³"},
    Field{"fu", &Material::ultimate_stress, positive, "Pa"},
    Field{"fracture_strain", &Material::fracture_strain, Range{0, true, unlimited, "a number > 0"}},
    Field{"brittle", &Material::brittle},
    Field{"damping_ratio", &Material::damping_ratio, not_negative},
    Field{"rate_D", &Material::rate_D, positive, "1/s"},
    Field{"rate_q", &Material::rate_q, Range{1, false, {}, "a number >= 1"}},
    Field{"friction", &Material::friction, not_negative},
    Field{"restitution", &Material::restitution, not_negative}};

/// What overrides a joint's section and material; `elastic` and `hinge_length` besides.
inline constexpr std::tuple overrides{
    Field{"moment", &JointOverrides::moment, limit, "N m"},
    Field{"moment_reverse", &JointOverrides::moment_reverse, limit, "N m"},
    Field{"axial", &JointOverrides::axial, limit, "N"},
    Field{"axial_compression", &JointOverrides::axial_compression, limit, "N"},
    Field{"shear", &JointOverrides::shear, limit, "N"},
    Field{"stiffness_axial", &JointOverrides::stiffness_axial, spring, "N/m"},
    Field{"stiffness_shear", &JointOverrides::stiffness_shear, spring, "N/m"},
    Field{"stiffness_moment", &JointOverrides::stiffness_moment, spring, "N m/rad"},
    Field{"max_rotation", &JointOverrides::max_rotation, limit, "rad"},
    Field{"max_elongation", &JointOverrides::max_elongation, limit, "m"},
    Field{"max_compression", &JointOverrides::max_compression, limit, "m"},
    Field{"max_slip", &JointOverrides::max_slip, limit, "m"},
    Field{"combine", &JointOverrides::combine},
    Field{"hold", &JointOverrides::hold}};

/// `elastic` of an override, where it is an object.
inline constexpr std::tuple elastic{
    Field{"frequency", &JointOverrides::frequency, positive, "Hz"},
    Field{"damping_ratio", &JointOverrides::damping_ratio, not_negative},
    Field{"elastic_rotation", &JointOverrides::elastic_rotation, positive, "rad"}};

/// A body; type, outline, material, profile, split and overrides besides.
inline constexpr std::tuple body{Field{"name", &BodyDef::name, any_number, "", true},
                                 Field{"at", &BodyDef::at, any_number, "m"},
                                 Field{"angle", &BodyDef::angle, any_number, "rad"},
                                 Field{"velocity", &BodyDef::velocity, any_number, "m/s"},
                                 Field{"angular_velocity", &BodyDef::angular_velocity, any_number, "rad/s"},
                                 Field{"depth", &BodyDef::depth, positive, "m"},
                                 Field{"group", &BodyDef::group},
                                 Field{"collides", &BodyDef::collides},
                                 Field{"price", &BodyDef::price, not_negative, "1/kg"},
                                 Field{"assembly", &BodyDef::assembly}};

/// A joint between bodies; `between`, its place, `kind`, `drive` and overrides besides.
inline constexpr std::tuple joint{Field{"gap", &JointBetweenDef::gap, positive, "m"},
                                  Field{"length", &JointBetweenDef::length, positive, "m"},
                                  Field{"welded", &JointBetweenDef::welded}};

/// A drive; `row` besides.
inline constexpr std::tuple drive{Field{"position", &DriveDef::position, any_number, "m or rad"},
                                  Field{"speed", &DriveDef::speed, any_number, "m/s or rad/s"},
                                  Field{"cap", &DriveDef::cap, spring, "N or N m"},
                                  Field{"from", &DriveDef::from, not_negative, "s"},
                                  Field{"ramp", &DriveDef::ramp, not_negative, "s"}};

/// The springs of a support.
inline constexpr std::tuple springs{Field{"x", &SupportDef::stiffness_x, positive, "N/m"},
                                    Field{"y", &SupportDef::stiffness_y, positive, "N/m"},
                                    Field{"angle", &SupportDef::stiffness_angle, positive, "N m/rad"}};

/// A support; `fix`, springs and `displacement` besides.
inline constexpr std::tuple support{Field{"body", &SupportDef::body, any_number, "", true},
                                    Field{"at", &SupportDef::at, any_number, "m", true},
                                    Field{"ramp", &SupportDef::ramp, not_negative, "s"}};

inline constexpr std::tuple load{Field{"body", &LoadDef::body, any_number, "", true},
                                 Field{"at", &LoadDef::at, any_number, "m", true},
                                 Field{"force", &LoadDef::force, any_number, "N"},
                                 Field{"moment", &LoadDef::moment, any_number, "N m"},
                                 Field{"from", &LoadDef::from, not_negative, "s"},
                                 Field{"ramp", &LoadDef::ramp, not_negative, "s"},
                                 Field{"to", &LoadDef::to, limit, "s"}};

/// A wheel; `between` besides.
inline constexpr std::tuple wheel{Field{"at", &WheelDef::at, any_number, "m", true},
                                  Field{"axis", &WheelDef::axis},
                                  Field{"frequency", &WheelDef::frequency, not_negative, "Hz"},
                                  Field{"damping_ratio", &WheelDef::damping_ratio, not_negative},
                                  Field{"motor_speed", &WheelDef::motor_speed, any_number, "rad/s"},
                                  Field{"motor_torque", &WheelDef::motor_torque, not_negative, "N m"}};

/// A scene; its lists, materials and overrides besides.
inline constexpr std::tuple scene{Field{"gravity", &SceneDef::gravity, any_number, "m/s²"},
                                  Field{"gravity_ramp", &SceneDef::gravity_ramp, not_negative, "s"},
                                  Field{"sleep", &SceneDef::sleep},
                                  Field{"interaction", &SceneDef::interaction}};

/// The numbers of a calibrated joint; stiffness and place besides.
inline constexpr std::tuple calibrated{
    Field{"N", &PlannedJoint::N, limit, "N"},
    Field{"Nc", &PlannedJoint::Nc, limit, "N"},
    Field{"Q", &PlannedJoint::Q, limit, "N"},
    Field{"M", &PlannedJoint::M, limit, "N m"},
    Field{"M_reverse", &PlannedJoint::M_reverse, limit, "N m"},
    Field{"damping_ratio", &PlannedJoint::damping_ratio, not_negative},
    Field{"damping_frequency", &PlannedJoint::damping_frequency, not_negative, "Hz"},
    Field{"max_rotation", &PlannedJoint::max_rotation, limit, "rad"},
    Field{"max_elongation", &PlannedJoint::max_elongation, limit, "m"},
    Field{"max_compression", &PlannedJoint::max_compression, limit, "m"},
    Field{"max_slip", &PlannedJoint::max_slip, limit, "m"},
    Field{"hinge_length", &PlannedJoint::hinge_length, not_negative, "m"},
    Field{"height", &PlannedJoint::height, not_negative, "m"}};

inline constexpr std::tuple stiffness{Field{"N", &PlannedJoint::Stiffness::N, limit, "N/m"},
                                      Field{"Q", &PlannedJoint::Stiffness::Q, limit, "N/m"},
                                      Field{"M", &PlannedJoint::Stiffness::M, limit, "N m/rad"}};

}  // namespace ductile::fields
