#include "kaustik/loader/radiance/cal_functions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace kaustik::radiance {
namespace {

using D = const double*;

double bounded(double low, double x, double high) { return x < low ? low : x > high ? high : x; }
double modulo(double n, double d) { return n - std::floor(n / d) * d; }
double grey_of(D a) {
  return std::max(0.0, 0.265074126 * a[0] + 0.670114631 * a[1] + 0.064811243 * a[2]);
}

/// A number between 0 and 1 that depends on `x` in no way that can be seen.
double random_of(double x) {
  const double turned = std::sin(x * 1e5 + 12.9898) * 43758.5453123;
  return turned - std::floor(turned);
}

/// Of a lattice point: the number that its slopes come from.
uint32_t lattice_hash(int64_t x, int64_t y, int64_t z) {
  uint64_t h = uint64_t(x) * 0x9e3779b97f4a7c15u ^ uint64_t(y) * 0xc2b2ae3d27d4eb4fu ^
               uint64_t(z) * 0x165667b19e3779f9u;
  h ^= h >> 29;
  h *= 0xbf58476d1ce4e5b9u;
  return uint32_t(h >> 32);
}

double noise_at(double x, double y, double z) {
  if (!(std::fabs(x) < 1e9 && std::fabs(y) < 1e9 && std::fabs(z) < 1e9)) return 0;
  const double cell[3] = {std::floor(x), std::floor(y), std::floor(z)};
  const double inside[3] = {x - cell[0], y - cell[1], z - cell[2]};
  double fade[3];
  for (int i = 0; i < 3; ++i) {
    const double t = inside[i];
    fade[i] = t * t * t * (t * (6 * t - 15) + 10);
  }
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const int at[3] = {corner & 1, corner >> 1 & 1, corner >> 2 & 1};
    const uint32_t hash =
        lattice_hash(int64_t(cell[0]) + at[0], int64_t(cell[1]) + at[1], int64_t(cell[2]) + at[2]);
    double weight = 1, slope = 0;
    for (int i = 0; i < 3; ++i) {
      weight *= at[i] ? fade[i] : 1 - fade[i];
      const double gradient = double(hash >> (10 * i) & 1023) / 511.5 - 1;
      slope += gradient * (inside[i] - at[i]);
    }
    sum += weight * slope;
  }
  return std::clamp(1.2 * sum, -1.0, 1.0);
}

/// Noise of all scales, each half as high as the one before.
double fractal_noise(D a) {
  double sum = 0, height = 0.5, scale = 1;
  for (int octave = 0; octave < 8; ++octave, height /= 2, scale *= 2)
    sum += height * noise_at(a[0] * scale, a[1] * scale, a[2] * scale);
  return sum;
}

/// |noise| of scales from a[3] up to 1.
double turbulence(D a) {
  double sum = 0;
  for (double s = std::max(a[3], 1e-3); s < 1.01; s *= 2)
    sum += std::fabs(noise_at(a[0] / s, a[1] / s, a[2] / s) * s);
  return sum;
}

double hermite(D a) {
  const double t = a[4], t2 = t * t, t3 = t2 * t;
  return a[0] * (2 * t3 - 3 * t2 + 1) + a[1] * (3 * t2 - 2 * t3) + a[2] * (t3 - 2 * t2 + t) +
         a[3] * (t3 - t2);
}
double bezier(D a) {
  const double t = a[4], s = 1 - t;
  return a[0] * s * s * s + 3 * a[1] * t * s * s + 3 * a[2] * t * t * s + a[3] * t * t * t;
}
double bspline(D a) {
  const double t = a[4], s = 1 - t;
  return (a[0] * s * s * s + a[1] * (3 * t * t * t - 6 * t * t + 4) +
          a[2] * (3 * s * s * s - 6 * s * s + 4) + a[3] * t * t * t) /
         6;
}

constexpr auto functions = std::to_array<CalFunction>({
    {"sqrt", 1, [](D a) { return std::sqrt(a[0]); }},
    {"Sqrt", 1, [](D a) { return a[0] > 0 ? std::sqrt(a[0]) : 0; }},
    {"sin", 1, [](D a) { return std::sin(a[0]); }},
    {"cos", 1, [](D a) { return std::cos(a[0]); }},
    {"tan", 1, [](D a) { return std::tan(a[0]); }},
    {"asin", 1, [](D a) { return std::asin(a[0]); }},
    {"acos", 1, [](D a) { return std::acos(a[0]); }},
    {"Asin", 1, [](D a) { return std::asin(bounded(-1, a[0], 1)); }},
    {"Acos", 1, [](D a) { return std::acos(bounded(-1, a[0], 1)); }},
    {"atan", 1, [](D a) { return std::atan(a[0]); }},
    {"atan2", 2, [](D a) { return std::atan2(a[0], a[1]); }},
    {"Atan2", 2, [](D a) { return std::atan2(a[0], a[1]); }},
    {"floor", 1, [](D a) { return std::floor(a[0]); }},
    {"ceil", 1, [](D a) { return std::ceil(a[0]); }},
    {"exp", 1, [](D a) { return std::exp(a[0]); }},
    {"Exp", 1, [](D a) { return a[0] < -100 ? 0 : std::exp(a[0]); }},
    {"log", 1, [](D a) { return std::log(a[0]); }},
    {"log10", 1, [](D a) { return std::log10(a[0]); }},
    {"erf", 1, [](D a) { return std::erf(a[0]); }},
    {"erfc", 1, [](D a) { return std::erfc(a[0]); }},
    {"rand", 1, [](D a) { return random_of(a[0]); }},
    {"hermite", 5, hermite},
    {"bezier", 5, bezier},
    {"bspline", 5, bspline},
    {"noise3", 3, [](D a) { return cal_noise(0, a[0], a[1], a[2]); }},
    {"noise3a", 3, [](D a) { return cal_noise(1, a[0], a[1], a[2]); }},
    {"noise3b", 3, [](D a) { return cal_noise(2, a[0], a[1], a[2]); }},
    {"noise3c", 3, [](D a) { return cal_noise(3, a[0], a[1], a[2]); }},
    {"fnoise3", 3, fractal_noise},
    {"turbulence", 4, turbulence},
    {"noise3x", 3, [](D a) { return cal_noise(1, a[0], a[1], a[2]); }},
    {"noise3y", 3, [](D a) { return cal_noise(2, a[0], a[1], a[2]); }},
    {"noise3z", 3, [](D a) { return cal_noise(3, a[0], a[1], a[2]); }},
    {"xor", 2, [](D a) { return a[0] > 0 ? (a[1] > 0 ? -1.0 : 1.0) : a[1]; }},
    {"and", 2, [](D a) { return a[0] > 0 ? a[1] : a[0]; }},
    {"or", 2, [](D a) { return a[0] > 0 ? a[0] : a[1]; }},
    {"not", 1, [](D a) { return a[0] > 0 ? -1.0 : 1.0; }},
    {"abs", 1, [](D a) { return std::fabs(a[0]); }},
    {"sgn", 1, [](D a) { return a[0] > 0   ? 1.0
                                : a[0] < 0 ? -1.0
                                           : 0.0; }},
    {"sq", 1, [](D a) { return a[0] * a[0]; }},
    {"max", 2, [](D a) { return std::max(a[0], a[1]); }},
    {"min", 2, [](D a) { return std::min(a[0], a[1]); }},
    {"bound", 3, [](D a) { return bounded(a[0], a[1], a[2]); }},
    {"inside", 3, [](D a) { return a[1] > a[0] ? a[2] - a[1] : a[1] - a[0]; }},
    {"frac", 1, [](D a) { return a[0] - std::floor(a[0]); }},
    {"mod", 2, [](D a) { return modulo(a[0], a[1]); }},
    {"tri", 2, [](D a) { return std::fabs(a[1] - modulo(a[0] - a[1], 2 * a[1])); }},
    {"linterp", 3, [](D a) { return (1 - a[0]) * a[1] + a[0] * a[2]; }},
    {"noop", 1, [](D a) { return a[0]; }},
    {"clip", 1, [](D a) { return bounded(0, a[0], 1); }},
    {"noneg", 1, [](D a) { return std::max(a[0], 0.0); }},
    {"red", 3, [](D a) { return std::max(a[0], 0.0); }},
    {"green", 3, [](D a) { return std::max(a[1], 0.0); }},
    {"blue", 3, [](D a) { return std::max(a[2], 0.0); }},
    {"grey", 3, grey_of},
    {"clip_r", 3, [](D a) { return bounded(0, a[0], 1); }},
    {"clip_g", 3, [](D a) { return bounded(0, a[1], 1); }},
    {"clip_b", 3, [](D a) { return bounded(0, a[2], 1); }},
    {"clipgrey", 3, [](D a) { return std::min(grey_of(a), 1.0); }},
});

}  // namespace

const CalFunction* find_cal_function(std::string_view name) {
  for (const CalFunction& function : functions)
    if (function.name == name) return &function;
  return nullptr;
}

double cal_noise(int component, double x, double y, double z) {
  if (component == 0) return noise_at(x, y, z);
  constexpr double step = 1e-3;
  double low[3] = {x, y, z}, high[3] = {x, y, z};
  low[component - 1] -= step;
  high[component - 1] += step;
  return (noise_at(high[0], high[1], high[2]) - noise_at(low[0], low[1], low[2])) / (2 * step);
}

std::string_view cal_start() {
  return R"(
PI : 3.14159265358979323846; DEGREE : PI / 180; FTINY : 1e-7;
AC = arg(0); A1 = arg(1); A2 = arg(2); A3 = arg(3); A4 = arg(4); A5 = arg(5);
A6 = arg(6); A7 = arg(7); A8 = arg(8); A9 = arg(9); A10 = arg(10);
D(i) = select(i, Dx, Dy, Dz); N(i) = select(i, Nx, Ny, Nz); P(i) = select(i, Px, Py, Pz);
noise3d(i, x, y, z) = select(i, noise3a(x,y,z), noise3b(x,y,z), noise3c(x,y,z));
dot(a, b) = a(1)*b(1) + a(2)*b(2) + a(3)*b(3);
cross(i, a, b) = select(i, a(2)*b(3) - a(3)*b(2), a(3)*b(1) - a(1)*b(3), a(1)*b(2) - a(2)*b(1));
fade(near, far, distance) =
  far + if(16 - distance, (near - far) / (1 + distance*distance), 0);
{ On planes: U lies level, V upward, N = U x V. }
level_sq`start = Nx*Nx + Ny*Ny;
U = if(level_sq`start - FTINY, (Py*Nx - Px*Ny) / level_sq`start, Px);
V = if(level_sq`start - FTINY, Pz - Nz*(Px*Nx + Py*Ny) / level_sq`start, Py);
)";
}

std::string_view cal_library_file(std::string_view name) {
  if (name == "picture.cal")
    return R"(
pic_u = Px; pic_v = Py;
pic_aspect = if(arg(0) - .5, arg(1), 1);
width`picture = max(1, 1 / pic_aspect); height`picture = max(1, pic_aspect);
wide`picture = if(pic_aspect - 1, 1, 1 / pic_aspect);
high`picture = if(pic_aspect - 1, pic_aspect, 1);
inpic = if(min(min(pic_u, pic_v), min(wide`picture - pic_u, high`picture - pic_v)), 1, 0);
stag_row`picture = frac(pic_v / height`picture / 2) - .5;
stag_u = mod(if(stag_row`picture, pic_u, pic_u + width`picture / 2), width`picture);
stag_v = mod(pic_v, height`picture);
tile_u = mod(pic_u, width`picture); tile_v = mod(pic_v, height`picture);
match_u = tri(pic_u, width`picture); match_v = tri(pic_v, height`picture);
fadered(r,g,b) = fade(r, A2, T*.1); fadegreen(r,g,b) = fade(g, A3, T*.1);
fadeblue(r,g,b) = fade(b, A4, T*.1); fadegrey(r,g,b) = fade(grey(r,g,b), A2, T*.1);
)";
  // Rings of wood about an axis, in cells 50 wide; dark where one ends.
  if (name == "woodpat.cal")
    return R"(
xgrain = grain`wood(Py, Pz); ygrain = grain`wood(Px, Pz); zgrain = grain`wood(Px, Py);
grain`wood(a, b) = shade`wood(frac(depth`wood(mod(a, 50) - 25, mod(b, 50) - 25)));
depth`wood(a, b) = sqrt(a*a + b*b + 25) + 7 * fnoise3(Px/40, Py/40, Pz/40);
shade`wood(t) = .6 + A1 * (if(t - .5, 2 - 2*t, 2*t) - .5);
)";
  // Lamps by ies2rad: their intensity over the area that is seen of them. Angles in degrees, from
  // straight down, and about the z axis from +x.
  if (name == "source.cal")
    return R"(
corr(v) = max(0, if(AC - .5, A1 * v, v));
flatcorr(v) = corr(v) / Rdot;
boxcorr(v) = corr(v) / (abs(Dx)*A3*A4 + abs(Dy)*A2*A4 + abs(Dz)*A2*A3);
lboxcorr(v) = boxcorr(v);
cylcorr(v) = corr(v) / (A2*A3*Sqrt(1 - Dz*Dz) + PI/4 * A2*A2 * abs(Dz));
src_theta = Acos(Dz) / DEGREE;
src_phi = mod(Atan2(-Dy, -Dx) / DEGREE, 360);
src_phi2 = tri(src_phi, 180); src_phi4 = tri(src_phi, 90);
srcB_vert = Atan2(-Dx, Dz) / DEGREE; srcB_horiz = Atan2(Dy, Dz) / DEGREE;
srcB_vert2 = abs(srcB_vert); srcB_horiz2 = abs(srcB_horiz);
)";
  return "";
}

}  // namespace kaustik::radiance
