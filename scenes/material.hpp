// Computes weight and stiffness of a plain round wire from its material and diameter.
//
// The numbers are handbook values. For a metal they are right within a few per cent, whatever the
// temper. The modulus of nylon, fluorocarbon and gut depends on stress, time and humidity, by half
// and more (Lynch-Aird & Woodhouse 2017, 2018, Materials 10:497 and 11:2160). A wound string is no
// wire: it has the stiffness of the core, and weighs more. Its numbers stand in the scene.
#pragma once

#include <numbers>

namespace jvari {

struct Material {
    double density;  // [kg/m^3]
    double modulus;  // Young's [Pa]
};
inline constexpr const char* material_names[] = {
    "steel", "nickel", "brass", "bronze", "phosphor bronze", "nylon", "fluorocarbon", "gut"};
inline constexpr Material materials[] = {{7850, 2e11},   {8900, 2e11},   {8500, 1.05e11},
                                         {8700, 1.1e11}, {8800, 1.1e11}, {1140, 5e9},
                                         {1780, 6e9},    {1300, 6e9}};

constexpr double linear_density_of(const Material& m, double diameter) {  // [kg/m]
    return m.density * std::numbers::pi / 4 * diameter * diameter;
}
constexpr double bending_stiffness_of(const Material& m, double diameter) {  // [N m^2]
    return m.modulus * std::numbers::pi / 64 * diameter * diameter * diameter * diameter;
}

}  // namespace jvari
