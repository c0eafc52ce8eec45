#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "kaustik/light/intensity_table.h"

namespace kaustik {

/// What a file says about a luminaire: how much light it sends where.
struct Photometry {
  /// In cd. The axis is the photometric zero; turns are those of C (of types A and B: as C has
  /// them).
  IntensityTable candelas;
  /// "3 lamps of 1000 lm; multiplier 1.2; type C": what the file says about its numbers.
  std::string facts;
  /// What is odd in the file and how it was taken, a sentence each without a full stop.
  std::vector<std::string> remarks = {};
};

/// Whether a file is one of them, not a picture, by its name or its first bytes.
bool is_photometry(const std::string& name, std::string_view head);
/// IES LM-63 of 1986, 1991, 1995, 2002 and 2019, or EULUMDAT. Units and grammar after the
/// standards' descriptions in Ashdown, "Parsing the IESNA LM-63 photometric data file" (1998), and
/// the EULUMDAT file format specification of AGi32's Photometric Toolbox. Throws Error(input) in
/// `name`, with the line, for what is none.
Photometry read_photometry(std::string_view text, const std::string& name);

// ---- what the readers of both formats share ----

/// Intensities as they are measured: one plane after the other, all at the same angles.
struct PhotometricPlanes {
  std::vector<double> planes, angles;  ///< degrees; of type C: C and γ
  std::vector<double> candelas;        ///< plane by plane
  bool mirror_at_0 = false;            ///< C and 360 − C are alike
  bool mirror_at_90 = false;           ///< C and 180 − C are alike

  double at(size_t plane, size_t angle) const { return candelas[plane * angles.size() + angle]; }
};

/// Sorts planes and angles, keeps one of equal ones, and makes negative intensities zero; tells
/// what it did.
void tidy(PhotometricPlanes& planes, std::vector<std::string>& remarks);
/// Type C all around. `planes` are tidy; their angles lie between 0 and 180.
IntensityTable table_of_planes(const PhotometricPlanes& planes, std::vector<std::string>& remarks);
/// Types B and A: `planes` are those of H, `angles` V, each from −90 to 90 or from 0, where both
/// sides are alike. Of B, d = cos H (cos V · z + sin V · c0) + sin H · c90, where z is the
/// photometric zero, and c0 and c90 are the directions of the planes C of those names; of A,
/// d = cos V (cos H · z + sin H · c0) + sin V · c90. Sampled by degrees.
IntensityTable table_of_sheaves(const PhotometricPlanes& planes, bool is_type_a);

Photometry read_ies(std::string_view text, const std::string& name);
Photometry read_eulumdat(std::string_view text, const std::string& name);

}  // namespace kaustik
