#pragma once
#include "kaustik/base/vec.h"
#include "kaustik/loader/radiance/command_line.h"

namespace kaustik::radiance {

/// Where the sun stands, as gensky and gendaylit ask for it.
struct SunPlace {
  double altitude = 0, azimuth = 0;  ///< radians; the azimuth from south to west
  double day = 150;                  ///< of the year, from 1
  /// Toward the sun: +x is east, +y north, +z up.
  Vec3d direction() const;
};

/// The first arguments of both programs, `month day hour` or `-ang altitude azimuth`, and the
/// options for the place: latitude, longitude and meridian in degrees, north and west positive.
class SunPlaceReader {
 public:
  /// Takes the first arguments.
  explicit SunPlaceReader(CommandArguments& arguments);
  /// True if it was one of -a, -o, -m, -y.
  bool take_option(const std::string& option);
  bool has_year() const { return has_year_; }
  SunPlace place() const;

 private:
  void read_hour(std::string word);

  CommandArguments& arguments_;
  bool by_angles_ = false, is_solar_time_ = false, has_zone_ = false, has_year_ = false;
  double altitude_ = 0, azimuth_ = 0, hour_ = 0;
  int month_ = 1, day_ = 1;
  double latitude_ = 37.815, longitude_ = 122.04, meridian_ = 120;
};

}  // namespace kaustik::radiance
