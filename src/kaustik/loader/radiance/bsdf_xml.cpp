#include "kaustik/loader/radiance/bsdf_xml.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <pugixml.hpp>
#include <string_view>
#include <vector>

#include "kaustik/loader/radiance/angles.h"
#include "kaustik/loader/radiance/number_text.h"

namespace kaustik::radiance {
namespace {

/// Rings of patches from the normal outward: up to that angle, and how many.
struct Ring {
  double end_degrees;
  size_t patches;
};

std::vector<Ring> rings_of(size_t patches) {
  switch (patches) {
    case 145:
      return {{5, 1},   {15, 8},  {25, 16}, {35, 20}, {45, 24},
              {55, 24}, {65, 24}, {75, 16}, {90, 12}};
    case 73:
    case 77:
      return {{6.5, 1},   {19.5, 8},  {32.5, 12},        {45.5, 16},
              {58.5, 20}, {71.5, 12}, {90, patches - 69}};
    case 41:
      return {{9, 1}, {27, 8}, {45, 12}, {63, 12}, {90, 8}};
    default:
      return {};
  }
}

/// Projected solid angles of the patches; they add up to π.
std::vector<double> projected_angles(size_t patches) {
  std::vector<double> found;
  double inner = 0;
  for (const Ring& ring : rings_of(patches)) {
    const double outer = std::pow(std::sin(ring.end_degrees * degree), 2);
    found.insert(found.end(), ring.patches,
                 std::numbers::pi * (outer - inner) / double(ring.patches));
    inner = outer;
  }
  return found;
}

std::vector<double> numbers_in_text(std::string_view text) {
  std::vector<double> found;
  constexpr size_t most = 145 * 145;
  while (found.size() <= most) {
    const size_t begin = text.find_first_not_of(" \t\r\n,");
    if (begin == std::string_view::npos) break;
    text.remove_prefix(begin);
    const size_t end = std::min(text.find_first_of(" \t\r\n,"), text.size());
    const auto value = number_of(text.substr(0, end));
    if (!value) return {};
    found.push_back(*value);
    text.remove_prefix(end);
  }
  return found;
}

/// ∫∫ f cosθ cosθ' over both hemispheres, over π.
std::optional<double> share_of(const std::vector<double>& matrix) {
  const auto n = size_t(std::lround(std::sqrt(double(matrix.size()))));
  const std::vector<double> angles = projected_angles(n);
  if (angles.empty() || n * n != matrix.size() || angles.size() != n) return std::nullopt;
  double sum = 0;
  for (size_t i = 0; i < n; ++i)
    for (size_t j = 0; j < n; ++j) sum += matrix[i * n + j] * angles[i] * angles[j];
  return std::clamp(sum / std::numbers::pi, 0.0, 1.0);
}

}  // namespace

std::optional<BsdfShares> read_bsdf_shares(const std::string& text) {
  pugi::xml_document document;
  if (!document.load_buffer(text.data(), text.size())) return std::nullopt;
  const pugi::xml_node layer = document.child("WindowElement").child("Optical").child("Layer");
  std::optional<double> reflected, transmitted;
  for (const pugi::xml_node data : layer.children("WavelengthData")) {
    if (std::string_view(data.child_value("Wavelength")).find("Visible") == std::string_view::npos)
      continue;
    const pugi::xml_node block = data.child("WavelengthDataBlock");
    const std::string_view direction = block.child_value("WavelengthDataDirection");
    const bool is_front = direction.find("Front") != std::string_view::npos;
    if (!is_front && direction.find("Transmission") == std::string_view::npos) continue;
    const auto share = share_of(numbers_in_text(block.child_value("ScatteringData")));
    if (direction.find("Transmission") != std::string_view::npos) {
      if (share && (is_front || !transmitted)) transmitted = share;
    } else if (share) {
      reflected = share;
    }
  }
  if (!reflected && !transmitted) return std::nullopt;
  return BsdfShares{reflected.value_or(0), transmitted.value_or(0)};
}

}  // namespace kaustik::radiance
