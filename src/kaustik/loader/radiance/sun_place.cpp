#include "kaustik/loader/radiance/sun_place.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "kaustik/loader/radiance/angles.h"
#include "kaustik/loader/radiance/number_text.h"

namespace kaustik::radiance {
namespace {

/// Meridians of time zones, degrees west. Names that stand for two zones mean the American one.
constexpr auto zones = std::to_array<std::pair<std::string_view, double>>({
    {"YST", 135},  {"YDT", 120},   {"PST", 120},   {"PDT", 105}, {"MST", 105},   {"MDT", 90},
    {"CST", 90},   {"CDT", 75},    {"EST", 75},    {"EDT", 60},  {"AST", 60},    {"ADT", 45},
    {"NST", 52.5}, {"NDT", 37.5},  {"GMT", 0},     {"BST", -15}, {"CET", -15},   {"CEST", -30},
    {"EET", -30},  {"EEST", -45},  {"GST", -60},   {"GDT", -75}, {"IST", -82.5}, {"IDT", -97.5},
    {"JST", -135}, {"NZST", -180}, {"NZDT", -195},
});

int day_of_year(int month, int day) {
  constexpr int before[12] = {0, 31, 59, 90, 120, 151, 181, 212, 243, 273, 304, 334};
  return before[month - 1] + day;
}

/// IES, "Recommended Practice for the Calculation of Daylight Availability" (1984): the
/// declination of the sun, and solar time less standard time but for the longitude, hours.
double declination_on(double day) {
  return 0.4093 * std::sin(2 * std::numbers::pi / 368 * (day - 81));
}
double equation_of_time(double day) {
  return 0.170 * std::sin(4 * std::numbers::pi / 373 * (day - 80)) -
         0.129 * std::sin(2 * std::numbers::pi / 355 * (day - 8));
}

}  // namespace

Vec3d SunPlace::direction() const {
  return {-std::sin(azimuth) * std::cos(altitude), -std::cos(azimuth) * std::cos(altitude),
          std::sin(altitude)};
}

SunPlaceReader::SunPlaceReader(CommandArguments& arguments) : arguments_(arguments) {
  const std::string first = arguments.text();
  if (first == "-ang") {
    by_angles_ = true;
    altitude_ = arguments.number() * degree;
    azimuth_ = arguments.number() * degree;
    return;
  }
  const auto month = number_of(first);
  const double day = arguments.number();
  if (!month || !(*month >= 1 && *month <= 12) || !(day >= 1 && day <= 31))
    arguments.refuse(fmt::format("'{}' has no month and day", arguments.name()));
  month_ = int(*month);
  day_ = int(day);
  read_hour(arguments.text());
}

/// "14", "14.5", "14:30", "+14" by the sun, "14:30CET".
void SunPlaceReader::read_hour(std::string word) {
  is_solar_time_ = word.starts_with('+');
  if (is_solar_time_) word.erase(0, 1);
  const size_t zone = std::min(word.find_first_not_of("0123456789.:"), word.size());
  std::string name = word.substr(zone);
  std::transform(name.begin(), name.end(), name.begin(),
                 [](char c) { return c >= 'a' && c <= 'z' ? char(c - 'a' + 'A') : c; });
  word.resize(zone);
  const size_t colon = std::min(word.find(':'), word.size());
  const auto hours = number_of(std::string_view(word).substr(0, colon));
  const auto minutes =
      colon < word.size() ? number_of(std::string_view(word).substr(colon + 1)) : 0.0;
  const auto found =
      std::find_if(zones.begin(), zones.end(), [&](const auto& row) { return row.first == name; });
  if (!hours || !minutes || *hours > 24 || (!name.empty() && found == zones.end()))
    arguments_.refuse(
        fmt::format("'{}' has no hour such as 14.5, 14:30 or 14:30CET", arguments_.name()));
  hour_ = *hours + *minutes / 60;
  if (name.empty()) return;
  has_zone_ = true;
  meridian_ = found->second;
}

bool SunPlaceReader::take_option(const std::string& option) {
  if (option == "-a") {
    latitude_ = arguments_.number();
  } else if (option == "-o") {
    longitude_ = arguments_.number();
  } else if (option == "-m") {
    const double meridian = arguments_.number();
    if (!has_zone_) meridian_ = meridian;
  } else if (option == "-y") {
    arguments_.number();
    has_year_ = true;
  } else {
    return false;
  }
  return true;
}

SunPlace SunPlaceReader::place() const {
  if (by_angles_) return {altitude_, azimuth_, 150};
  const double day = day_of_year(month_, day_), declination = declination_on(day);
  const double solar_hour =
      is_solar_time_ ? hour_ : hour_ + equation_of_time(day) + (meridian_ - longitude_) / 15;
  const double latitude = latitude_ * degree, turn = solar_hour * std::numbers::pi / 12;
  const double altitude = std::asin(std::sin(latitude) * std::sin(declination) -
                                    std::cos(latitude) * std::cos(declination) * std::cos(turn));
  const double azimuth =
      -std::atan2(std::cos(declination) * std::sin(turn),
                  -std::cos(latitude) * std::sin(declination) -
                      std::sin(latitude) * std::cos(declination) * std::cos(turn));
  return {altitude, azimuth, day};
}

}  // namespace kaustik::radiance
