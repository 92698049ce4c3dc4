#pragma once

/// \file
/// The error bounds of the filtered expressions, derived from the expressions themselves.
///
/// Written by `touchstone-derive --emit filters/include/touchstone/filters/error_bounds.hpp`; not
/// to be edited. A test fails if it differs from what the derivation gives, another has Gappa prove
/// each bound.
///
/// (u: half the distance of 1 and the next number; x: the greatest magnitude of a coordinate.)

#include "touchstone/filters/error_bound.hpp"

namespace touchstone::filters {

/// edge_edge in double: 10 u x and underflow.
inline constexpr ErrorBound<double, 1> edge_edge_double{
    .coefficients = {{0x0.0000000000006p-1022, 0x1.4000000000006p-50}},
    .greatest_x = 0x1p+1021,
};

/// edge_edge in float: 10 u x and underflow.
inline constexpr ErrorBound<float, 1> edge_edge_float{
    .coefficients = {{0x1.8p-147F, 0x1.40000cp-21F}},
    .greatest_x = 0x1p+125F,
};

/// vertex_face in double: 20 u x and underflow.
inline constexpr ErrorBound<double, 1> vertex_face_double{
    .coefficients = {{0x0.0000000000007p-1022, 0x1.4000000000006p-49}},
    .greatest_x = 0x1p+1020,
};

/// vertex_face in float: 20 u x and underflow.
inline constexpr ErrorBound<float, 1> vertex_face_float{
    .coefficients = {{0x1.cp-147F, 0x1.40000cp-20F}},
    .greatest_x = 0x1p+124F,
};

/// edge_edge_separated in double: 13 u x and underflow.
inline constexpr ErrorBound<double, 1> edge_edge_separated_double{
    .coefficients = {{0x0.0000000000006p-1022, 0x1.a000000000007p-50}},
    .greatest_x = 0x1p+1021,
};

/// edge_edge_separated in float: 13 u x and underflow.
inline constexpr ErrorBound<float, 1> edge_edge_separated_float{
    .coefficients = {{0x1.8p-147F, 0x1.a0000ep-21F}},
    .greatest_x = 0x1p+125F,
};

/// vertex_face_separated in double: 25 u x and underflow.
inline constexpr ErrorBound<double, 1> vertex_face_separated_double{
    .coefficients = {{0x0.0000000000007p-1022, 0x1.9000000000007p-49}},
    .greatest_x = 0x1p+1020,
};

/// vertex_face_separated in float: 25 u x and underflow.
inline constexpr ErrorBound<float, 1> vertex_face_separated_float{
    .coefficients = {{0x1.cp-147F, 0x1.90000ep-20F}},
    .greatest_x = 0x1p+124F,
};

/// measured_projected_gap in double: 34 u x^2 and underflow.
inline constexpr ErrorBound<double, 2> measured_projected_gap_double{
    .coefficients = {{0x0.0000000000006p-1022, 0x0.0000000000009p-1022, 0x1.1000000000008p-48}},
    .greatest_x = 0x1p+510,
};

/// measured_determinant_end in double: 82 u x^3 and underflow.
inline constexpr ErrorBound<double, 3> measured_determinant_end_double{
    .coefficients = {{0x0.0000000000004p-1022, 0x0.0000000000006p-1022, 0x0.000000000001ep-1022,
                      0x1.480000000001p-47}},
    .greatest_x = 0x1p+340,
};

/// measured_determinant_end in float: 82 u x^3 and underflow.
inline constexpr ErrorBound<float, 3> measured_determinant_end_float{
    .coefficients = {{0x1p-147F, 0x1.8p-147F, 0x1.ep-145F, 0x1.48002p-18F}},
    .greatest_x = 0x1p+41F,
};

/// measured_determinant_middle in double: 276 u x^3 and underflow.
inline constexpr ErrorBound<double, 3> measured_determinant_middle_double{
    .coefficients = {{0x0.0000000000006p-1022, 0x0.000000000000cp-1022, 0x0.0000000000054p-1022,
                      0x1.140000000000ep-45}},
    .greatest_x = 0x1p+339,
};

/// measured_determinant_middle in float: 276 u x^3 and underflow.
inline constexpr ErrorBound<float, 3> measured_determinant_middle_float{
    .coefficients = {{0x1.8p-147F, 0x1.8p-146F, 0x1.5p-143F, 0x1.14001cp-16F}},
    .greatest_x = 0x1p+40F,
};

/// measured_orientation_end in double: 70 u x^3 and underflow.
inline constexpr ErrorBound<double, 3> measured_orientation_end_double{
    .coefficients = {{0x0.0000000000004p-1022, 0x0.0000000000006p-1022, 0x0.0000000000018p-1022,
                      0x1.180000000000dp-47}},
    .greatest_x = 0x1p+340,
};

/// measured_orientation_end in float: 70 u x^3 and underflow.
inline constexpr ErrorBound<float, 3> measured_orientation_end_float{
    .coefficients = {{0x1p-147F, 0x1.8p-147F, 0x1.8p-145F, 0x1.18001ap-18F}},
    .greatest_x = 0x1p+41F,
};

/// measured_orientation_middle in double: 152 u x^3 and underflow.
inline constexpr ErrorBound<double, 3> measured_orientation_middle_double{
    .coefficients = {{0x0.0000000000006p-1022, 0x0.0000000000009p-1022, 0x0.000000000002dp-1022,
                      0x1.300000000000fp-46}},
    .greatest_x = 0x1p+339,
};

/// measured_orientation_middle in float: 152 u x^3 and underflow.
inline constexpr ErrorBound<float, 3> measured_orientation_middle_float{
    .coefficients = {{0x1.8p-147F, 0x1.2p-146F, 0x1.68p-144F, 0x1.30001ep-17F}},
    .greatest_x = 0x1p+41F,
};

/// determinant_end in double_double: 64 u x^3 and underflow.
inline constexpr ErrorBound<double, 3> determinant_end_double_double{
    .coefficients = {{0x0.000000000001bp-1022, 0x0.0000000000033p-1022, 0x0.0000000000123p-1022,
                      0x1.000000000000ap-97}},
    .greatest_x = 0x1p+328,
};

/// measured_advanced_gap in double: 56 u x^2 and underflow.
inline constexpr ErrorBound<double, 2> measured_advanced_gap_double{
    .coefficients = {{0x0.0000000000007p-1022, 0x0.000000000000ap-1022, 0x1.c00000000000ep-48}},
    .greatest_x = 0x1p+510,
};

/// measured_advanced_gap in float: 56 u x^2 and underflow.
inline constexpr ErrorBound<float, 2> measured_advanced_gap_float{
    .coefficients = {{0x1.cp-147F, 0x1.4p-146F, 0x1.c0001cp-19F}},
    .greatest_x = 0x1p+62F,
};

/// advanced_gap in double_double: 42 u x^2 and underflow.
inline constexpr ErrorBound<double, 2> advanced_gap_double_double{
    .coefficients = {{0x0.000000000004bp-1022, 0x0.0000000000002p-1022, 0x1.5000000000008p-98}},
    .greatest_x = 0x1p+493,
};

/// corner_gap in double: 13 u x^2 and underflow.
inline constexpr ErrorBound<double, 2> corner_gap_double{
    .coefficients = {{0x0.0000000000005p-1022, 0x0.0000000000002p-1022, 0x1.a00000000000bp-50}},
    .greatest_x = 0x1p+510,
};

/// component_sum in double: 5 u x and underflow.
inline constexpr ErrorBound<double, 1> component_sum_double{
    .coefficients = {{0x0.0000000000001p-1022, 0x1.4000000000005p-51}},
    .greatest_x = 0x1p+1021,
};

/// component_sum in float: 5 u x and underflow.
inline constexpr ErrorBound<float, 1> component_sum_float{
    .coefficients = {{0x1p-149F, 0x1.40000ap-22F}},
    .greatest_x = 0x1p+125F,
};

/// squared_length in double: 8 u x^2 and underflow.
inline constexpr ErrorBound<double, 2> squared_length_double{
    .coefficients = {{0x0.0000000000004p-1022, 0x0.0000000000002p-1022, 0x1.0000000000007p-50}},
    .greatest_x = 0x1p+510,
};

/// squared_length in float: 8 u x^2 and underflow.
inline constexpr ErrorBound<float, 2> squared_length_float{
    .coefficients = {{0x1p-147F, 0x1p-148F, 0x1.00000ep-21F}},
    .greatest_x = 0x1p+62F,
};

/// length_defect in double_double: 13 u x^2 and underflow.
inline constexpr ErrorBound<double, 2> length_defect_double_double{
    .coefficients = {{0x0.0000000000023p-1022, 0x0.0000000000002p-1022, 0x1.a00000000000ap-100}},
    .greatest_x = 0x1p+493,
};

/// contact_component in double_double: 17 u x and underflow.
inline constexpr ErrorBound<double, 1> contact_component_double_double{
    .coefficients = {{0x0.0000000000042p-1022, 0x1.1000000000004p-99}},
    .greatest_x = 0x1p+986,
};

/// position in double: 2 u x and underflow.
inline constexpr ErrorBound<double, 1> position_double{
    .coefficients = {{0x0.0000000000003p-1022, 0x1.0000000000004p-52}},
    .greatest_x = 0x1p+1022,
};

/// quadratic_edge_edge_separated in double: 17 u x and underflow.
inline constexpr ErrorBound<double, 1> quadratic_edge_edge_separated_double{
    .coefficients = {{0x0.0000000000008p-1022, 0x1.1000000000005p-49}},
    .greatest_x = 0x1p+1021,
};

/// quadratic_vertex_face_separated in double: 33 u x and underflow.
inline constexpr ErrorBound<double, 1> quadratic_vertex_face_separated_double{
    .coefficients = {{0x0.000000000000bp-1022, 0x1.0800000000005p-48}},
    .greatest_x = 0x1p+1020,
};

/// cubic_edge_edge_separated in double: 21 u x and underflow.
inline constexpr ErrorBound<double, 1> cubic_edge_edge_separated_double{
    .coefficients = {{0x0.000000000000ap-1022, 0x1.5000000000007p-49}},
    .greatest_x = 0x1p+1021,
};

/// cubic_vertex_face_separated in double: 41 u x and underflow.
inline constexpr ErrorBound<double, 1> cubic_vertex_face_separated_double{
    .coefficients = {{0x0.000000000000fp-1022, 0x1.4800000000007p-48}},
    .greatest_x = 0x1p+1020,
};

}  // namespace touchstone::filters
