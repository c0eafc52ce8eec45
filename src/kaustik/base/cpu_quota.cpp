#include "kaustik/base/cpu_quota.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <limits>
#include <optional>
#include <sstream>
#include <vector>

namespace kaustik {
namespace {

namespace fs = std::filesystem;

constexpr double no_quota = std::numeric_limits<double>::infinity();

enum class CgroupVersion { v1, v2 };

/// A tree of groups, as the process sees it.
struct Hierarchy {
  CgroupVersion version;
  std::string root;   ///< the group that is mounted
  std::string mount;  ///< the folder that it is mounted at
};

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, separator);) parts.push_back(part);
  return parts;
}

bool holds(const std::vector<std::string>& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

/// mountinfo writes blanks and such as \040.
std::string unescaped(const std::string& text) {
  const auto is_octal = [](char c) { return c >= '0' && c <= '7'; };
  std::string result;
  for (size_t i = 0; i < text.size(); ++i) {
    const bool is_escape = text[i] == '\\' && i + 3 < text.size() && is_octal(text[i + 1]) &&
                           is_octal(text[i + 2]) && is_octal(text[i + 3]);
    if (!is_escape) {
      result += text[i];
      continue;
    }
    result += char((text[i + 1] - '0') * 64 + (text[i + 2] - '0') * 8 + (text[i + 3] - '0'));
    i += 3;
  }
  return result;
}

/// A line of mountinfo: "36 35 98:0 /root /mount options [fields …] - type source options"; none if
/// it tells of no groups that limit processor time.
std::optional<Hierarchy> hierarchy_of(const std::string& line) {
  const std::vector<std::string> fields = split(line, ' ');
  const auto dash = std::find(fields.begin(), fields.end(), "-");
  if (dash - fields.begin() < 6 || fields.end() - dash < 4) return {};
  const std::string &type = dash[1], &options = dash[3];
  const bool is_v1 = type == "cgroup" && holds(split(options, ','), "cpu");
  if (type != "cgroup2" && !is_v1) return {};
  return Hierarchy{is_v1 ? CgroupVersion::v1 : CgroupVersion::v2, unescaped(fields[3]),
                   unescaped(fields[4])};
}

std::vector<Hierarchy> hierarchies(const std::string& root) {
  std::vector<Hierarchy> all;
  std::ifstream in(root + "/proc/self/mountinfo");
  for (std::string line; std::getline(in, line);)
    if (const auto hierarchy = hierarchy_of(line)) all.push_back(*hierarchy);
  return all;
}

/// The process's group in the tree of that version; none if it is in none. Lines of
/// /proc/self/cgroup are "number:controllers:group", in version 2 "0::group".
std::optional<std::string> own_group(const std::string& root, CgroupVersion version) {
  std::ifstream in(root + "/proc/self/cgroup");
  for (std::string line; std::getline(in, line);) {
    const size_t first = line.find(':');
    const size_t second = first == std::string::npos ? first : line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1);
    const bool is_it = version == CgroupVersion::v2 ? line.starts_with("0::")
                                                    : holds(split(controllers, ','), "cpu");
    if (is_it) return line.substr(second + 1);
  }
  return {};
}

/// Of cpu.max: "max 100000", or "150000 100000" for one and a half processors.
double quota_v2(const fs::path& folder) {
  std::ifstream in(folder / "cpu.max");
  double quota_us = 0, period_us = 0;
  // "max" is no number.
  if (!(in >> quota_us >> period_us) || !(quota_us > 0) || !(period_us > 0)) return no_quota;
  return quota_us / period_us;
}

/// A quota of -1 is none.
double quota_v1(const fs::path& folder) {
  std::ifstream quota(folder / "cpu.cfs_quota_us"), period(folder / "cpu.cfs_period_us");
  double quota_us = 0, period_us = 0;
  if (!(quota >> quota_us) || !(period >> period_us)) return no_quota;
  return quota_us > 0 && period_us > 0 ? quota_us / period_us : no_quota;
}

/// The group's place below the mounted one; the mounted one itself where the group isn't below it,
/// as in containers that see but their own part of the tree.
fs::path place_below(const std::string& group, const std::string& mounted) {
  const fs::path place = fs::path(group).lexically_relative(mounted);
  return place.empty() || *place.begin() == ".." ? fs::path(".") : place;
}

/// The tightest quota of the group and those above it, up to the mounted one.
double tightest_quota(const std::string& root, const Hierarchy& hierarchy,
                      const std::string& group) {
  const auto quota_of = hierarchy.version == CgroupVersion::v2 ? quota_v2 : quota_v1;
  fs::path folder = root + hierarchy.mount;
  double tightest = quota_of(folder);
  for (const fs::path& step : place_below(group, hierarchy.root))
    tightest = std::min(tightest, quota_of(folder /= step));
  return tightest;
}

}  // namespace

double cgroup_cpu_quota(const std::string& root) {
  double tightest = no_quota;
  for (const Hierarchy& hierarchy : hierarchies(root))
    if (const auto group = own_group(root, hierarchy.version))
      tightest = std::min(tightest, tightest_quota(root, hierarchy, *group));
  return tightest;
}

}  // namespace kaustik
