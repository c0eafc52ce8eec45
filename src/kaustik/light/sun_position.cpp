#include "kaustik/light/sun_position.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>

namespace kaustik {
namespace {

constexpr double earth_radius_over_distance = 6371.01 / 149597890;

std::chrono::year_month_day date_of(int year, int month, int day) {
  return {std::chrono::year(year), std::chrono::month(unsigned(month)),
          std::chrono::day(unsigned(day))};
}

}  // namespace

Horizontal horizontal(const Vec3d& direction) {
  constexpr double degree = std::numbers::pi / 180;
  const double azimuth = std::atan2(-direction.y, -direction.x) / degree;
  return {std::asin(std::clamp(direction.z, -1.0, 1.0)) / degree,
          azimuth < 0 ? azimuth + 360 : azimuth};
}

bool is_date(int year, int month, int day) { return date_of(year, month, day).ok(); }

Vec3d sun_direction_at(const PlaceAndTime& at) {
  const std::chrono::sys_days epoch = date_of(2000, 1, 1);
  const std::chrono::sys_days today = date_of(at.year, at.month, at.day);
  const double universal_hours = at.hour - at.timezone;
  // Days since noon of the first of January 2000.
  const double days = double((today - epoch).count()) - 0.5 + universal_hours / 24;

  const double omega = 2.1429 - 0.0010394594 * days;
  const double mean_longitude = 4.8950630 + 0.017202791698 * days;
  const double mean_anomaly = 6.2400600 + 0.0172019699 * days;
  const double ecliptic_longitude = mean_longitude + 0.03341607 * std::sin(mean_anomaly) +
                                    0.00034894 * std::sin(2 * mean_anomaly) - 0.0001134 -
                                    0.0000203 * std::sin(omega);
  const double obliquity = 0.4090928 - 6.2140e-9 * days + 0.0000396 * std::cos(omega);
  const double right_ascension =
      std::atan2(std::cos(obliquity) * std::sin(ecliptic_longitude), std::cos(ecliptic_longitude));
  const double declination = std::asin(std::sin(obliquity) * std::sin(ecliptic_longitude));

  const double sidereal_hours = 6.6974243242 + 0.0657098283 * days + universal_hours;
  const double hour_angle =
      (sidereal_hours * 15 + at.longitude) * (std::numbers::pi / 180) - right_ascension;
  const double latitude = at.latitude * (std::numbers::pi / 180);
  const double north = std::sin(declination) * std::cos(latitude) -
                       std::cos(declination) * std::sin(latitude) * std::cos(hour_angle);
  const double east = -std::cos(declination) * std::sin(hour_angle);
  const double up = std::sin(declination) * std::sin(latitude) +
                    std::cos(declination) * std::cos(latitude) * std::cos(hour_angle);
  // Seen from the ground, not from the middle of the earth.
  return Vec3d(-north, -east, up - earth_radius_over_distance).normalized();
}

}  // namespace kaustik
