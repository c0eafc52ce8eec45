#pragma once

namespace kaustik {

/// Carlson's symmetric integral R_G of three numbers that are not negative, by duplication
/// (Carlson, "Numerical computation of real or complex elliptic integrals", Numerical Algorithms
/// 1995; DLMF 19.21.10 and 19.36). Homogeneous of degree 1/2. An ellipse with half axes a and b has
/// the circumference 8 R_G(0, a², b²) (DLMF 19.30.5), an ellipsoid the area
/// 4π R_G(a² b², a² c², b² c²) (DLMF 19.33.1).
double carlson_rg(double x, double y, double z);

}  // namespace kaustik
