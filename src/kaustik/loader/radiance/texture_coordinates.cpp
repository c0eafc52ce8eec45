#include "kaustik/loader/radiance/texture_coordinates.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "kaustik/base/error.h"
#include "kaustik/base/file.h"
#include "kaustik/base/text_lines.h"
#include "kaustik/loader/radiance/cal_program.h"
#include "kaustik/loader/radiance/number_text.h"

namespace kaustik::radiance {
namespace {

using Coordinates = std::vector<std::pair<double, double>>;

Coordinates by_tangent(const Vec3d& tangent, const std::vector<Vec3d>& corners,
                       const Vec3d& normal) {
  Vec3d u = tangent - normal * normal.dot(tangent);
  if (!(u.length() > 1e-6)) u = normal.cross(Vec3d(normal.y, normal.z, normal.x));
  if (!(u.length() > 1e-6)) u = normal.cross(Vec3d(1, 0, 0));
  u = u.normalized();
  const Vec3d v = normal.cross(u);
  Coordinates found;
  for (const Vec3d& corner : corners) found.emplace_back(u.dot(corner), v.dot(corner));
  return found;
}

/// Whether in the middle of each side the coordinates are those between its ends.
bool are_straight(const PicturePattern& picture, const std::vector<PatternPoint>& corners,
                  const Coordinates& at_corners) {
  double largest = 1e-6;
  for (const auto& [u, v] : at_corners)
    largest = std::max(
        {largest, std::fabs(u - at_corners[0].first), std::fabs(v - at_corners[0].second)});
  for (size_t i = 0; i < corners.size(); ++i) {
    const size_t j = (i + 1) % corners.size();
    const auto [u, v] =
        picture.place_of({(corners[i].position + corners[j].position) * 0.5, corners[i].normal});
    const double du = u - (at_corners[i].first + at_corners[j].first) / 2;
    const double dv = v - (at_corners[i].second + at_corners[j].second) / 2;
    if (std::max(std::fabs(du), std::fabs(dv)) > 1e-3 * largest) return false;
  }
  return true;
}

Coordinates coordinates_of(const PicturePattern& picture, const std::vector<PatternPoint>& points,
                           bool is_flat, const Primitive& surface, Deviations& deviations) {
  try {
    Coordinates found;
    found.reserve(points.size());
    for (const PatternPoint& point : points) found.push_back(picture.place_of(point));
    if (is_flat && !are_straight(picture, points, found))
      deviations.approximated(name_of(surface),
                              "its picture lies evenly between the corners, where its function "
                              "bends it",
                              surface.place);
    const auto [width, height] = picture_size(picture.file());
    const double shorter = std::min(width, height);
    for (auto& [u, v] : found) {
      u *= shorter / width;
      v = 1 - v * shorter / height;
    }
    return found;
  } catch (const CalError&) {
    deviations.approximated(name_of(surface),
                            "its picture has no place on it, and shows one colour", surface.place);
    return Coordinates(points.size(), {0.5, 0.5});
  }
}

}  // namespace

Coordinates texture_coordinates(const Appearance& appearance, const std::vector<Vec3d>& corners,
                                const Vec3d& normal, const Primitive& polygon,
                                Deviations& deviations) {
  if (!appearance.picture)
    return appearance.tangent ? by_tangent(*appearance.tangent, corners, normal) : Coordinates();
  std::vector<PatternPoint> points;
  for (const Vec3d& corner : corners) points.push_back({corner, normal});
  return coordinates_of(*appearance.picture, points, true, polygon, deviations);
}

Coordinates picture_coordinates(const PicturePattern& picture,
                                const std::vector<PatternPoint>& points, const Primitive& surface,
                                Deviations& deviations) {
  return coordinates_of(picture, points, false, surface, deviations);
}

std::pair<double, double> picture_size(const std::string& path) {
  constexpr size_t head = 8192;
  std::vector<uint8_t> bytes;
  try {
    bytes = read_file_start(path, head);
  } catch (const Error&) {
    return {1, 1};
  }
  std::string_view rest(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (!rest.starts_with("#?")) return {1, 1};
  while (!rest.empty()) {
    std::string_view line = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(std::min(line.size() + 1, rest.size()));
    const auto axis = next_word(line), first = next_word(line), other = next_word(line),
               second = next_word(line);
    if (axis.size() != 2 || (axis[1] != 'Y' && axis[1] != 'X')) continue;
    const auto a = number_of(first), b = number_of(second);
    if (!a || !b || other.size() != 2 || !(*a >= 1) || !(*b >= 1)) continue;
    return axis[1] == 'Y' ? std::pair(*b, *a) : std::pair(*a, *b);
  }
  return {1, 1};
}

}  // namespace kaustik::radiance
