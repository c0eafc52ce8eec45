#include "kaustik/loader/radiance/pattern_functions.h"

#include <cmath>

#include "kaustik/loader/radiance/cal_functions.h"

namespace kaustik::radiance {
namespace {

double finite(double value) {
  if (!std::isfinite(value)) throw CalError("a function has no finite value");
  return value;
}

}  // namespace

PatternFunctions::PatternFunctions(std::string_view source,
                                   std::span<const std::string> expressions,
                                   std::vector<double> reals, const Transform& world_from_own)
    : reals_(std::move(reals)), own_from_world_(world_from_own.inverse()) {
  program_.add(cal_start());
  program_.add(source);
  for (const std::string& expression : expressions)
    roots_.push_back(program_.add_expression(expression));
  evaluator_.emplace(program_);
  evaluator_->set_function("arg", [this](std::span<const double> n) {
    const double index = std::floor(n.empty() ? 0 : n[0] + 0.5);
    if (index == 0) return double(reals_.size());
    if (!(index > 0 && index <= double(reals_.size())))
      throw CalError("an argument that a function asks for is missing");
    return reals_[size_t(index) - 1];
  });
  // The world's origin and axes, as the function's own space sees them.
  set({"Tx", "Ty", "Tz"}, placed_point(own_from_world_, Vec3d(0, 0, 0)));
  set({"Ix", "Iy", "Iz"}, placed_vector(own_from_world_, Vec3d(1, 0, 0)).normalized());
  set({"Jx", "Jy", "Jz"}, placed_vector(own_from_world_, Vec3d(0, 1, 0)).normalized());
  set({"Kx", "Ky", "Kz"}, placed_vector(own_from_world_, Vec3d(0, 0, 1)).normalized());
  evaluator_->set("S", scale_of(own_from_world_));
  for (const char* name : {"T", "Ts"}) evaluator_->set(name, 0);
  for (const char* name : {"CrP", "CgP", "CbP"}) evaluator_->set(name, 1);
}

void PatternFunctions::set(const char* const (&names)[3], const Vec3d& v) {
  for (int i = 0; i < 3; ++i) evaluator_->set(names[i], v[i]);
}

void PatternFunctions::stand_at(const PatternPoint& point) {
  const Vec3d n = placed_vector(own_from_world_, point.normal).normalized();
  const Vec3d d = placed_vector(own_from_world_, point.direction).normalized();
  set({"Px", "Py", "Pz"}, placed_point(own_from_world_, point.position));
  set({"Nx", "Ny", "Nz"}, n);
  set({"NxP", "NyP", "NzP"}, n);
  set({"Dx", "Dy", "Dz"}, d);
  const double cosine = -n.dot(d);
  evaluator_->set("Rdot", cosine);
  evaluator_->set("RdotP", cosine);
  evaluator_->set("Lu", point.u);
  evaluator_->set("Lv", point.v);
}

double PatternFunctions::value(size_t expression) {
  return finite(evaluator_->value(roots_.at(expression)));
}

double PatternFunctions::call(const std::string& name, std::span<const double> values) {
  return finite(evaluator_->call(name, values));
}

}  // namespace kaustik::radiance
