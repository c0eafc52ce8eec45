#pragma once
#include <cmath>
#include <cstddef>

namespace kaustik {

/// Four spectral lanes in one SIMD register. Transport code treats lanes alike and never names a
/// colour. In RGB mode lanes 0–2 are linear Rec. 709 red, green, blue and lane 3 is unused: it is
/// zero in everything emitted, so it stays zero in all that arrives (and finite in everything
/// else). Unit: whatever the variable says (radiance W/(sr·m²), flux W, reflectance 1).
class Spectrum {
 public:
  static constexpr int lane_count = 4;
  using Register = float __attribute__((vector_size(16)));

  Spectrum() : v_{0, 0, 0, 0} {}
  explicit Spectrum(float all) : v_{all, all, all, all} {}
  Spectrum(float a, float b, float c, float d) : v_{a, b, c, d} {}
  explicit Spectrum(Register v) : v_(v) {}

  float operator[](int lane) const { return v_[lane]; }
  void set(int lane, float value) { v_[lane] = value; }
  Register lanes() const { return v_; }

  Spectrum& operator+=(const Spectrum& o) { return v_ += o.v_, *this; }
  Spectrum& operator-=(const Spectrum& o) { return v_ -= o.v_, *this; }
  Spectrum& operator*=(const Spectrum& o) { return v_ *= o.v_, *this; }
  Spectrum& operator*=(float s) { return v_ *= s, *this; }
  friend Spectrum operator+(Spectrum a, const Spectrum& b) { return a += b; }
  friend Spectrum operator-(Spectrum a, const Spectrum& b) { return a -= b; }
  friend Spectrum operator*(Spectrum a, const Spectrum& b) { return a *= b; }
  friend Spectrum operator*(Spectrum a, float s) { return a *= s; }
  friend Spectrum operator*(float s, Spectrum a) { return a *= s; }
  friend Spectrum operator/(const Spectrum& a, const Spectrum& b) { return Spectrum(a.v_ / b.v_); }
  friend Spectrum operator/(Spectrum a, float s) { return a *= 1.0f / s; }
  friend bool operator==(const Spectrum& a, const Spectrum& b) {
    return a[0] == b[0] && a[1] == b[1] && a[2] == b[2] && a[3] == b[3];
  }

  float max_lane() const {
    const float a = v_[0] > v_[1] ? v_[0] : v_[1];
    const float b = v_[2] > v_[3] ? v_[2] : v_[3];
    return a > b ? a : b;
  }
  float sum() const { return (v_[0] + v_[1]) + (v_[2] + v_[3]); }
  bool is_zero() const { return v_[0] == 0 && v_[1] == 0 && v_[2] == 0 && v_[3] == 0; }
  bool is_finite() const { return std::isfinite(sum()); }

 private:
  Register v_;
};

/// The spectrum of linear Rec. 709 values for something emitted or seen: lane 3 is zero.
inline Spectrum spectrum_from_rgb(float r, float g, float b) { return {r, g, b, 0}; }

inline Spectrum sqrt(const Spectrum& s) {
  return {std::sqrt(s[0]), std::sqrt(s[1]), std::sqrt(s[2]), std::sqrt(s[3])};
}
inline Spectrum exp(const Spectrum& s) {
  return {std::exp(s[0]), std::exp(s[1]), std::exp(s[2]), std::exp(s[3])};
}

}  // namespace kaustik
