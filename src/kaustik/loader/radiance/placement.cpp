#include "kaustik/loader/radiance/placement.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "kaustik/base/error.h"
#include "kaustik/base/text_lines.h"

namespace kaustik::radiance {
namespace {

constexpr const char* xform_usage =
    "xform [-t x y z] [-rx|-ry|-rz degrees] [-s factor] [-mx|-my|-mz] [-i times] [-a copies] "
    "[-m modifier] [-n name] [-I] file";

/// What is repeated: `times` times, or for an array 0, 1, … times − 1 times.
struct Group {
  size_t times = 1;
  bool is_array = false;
  Transform once;
};

Transform power(Transform base, size_t exponent) {
  Transform result;
  for (; exponent > 0; exponent /= 2) {
    if (exponent % 2 == 1) result = base * result;
    base = base * base;
  }
  return result;
}

/// The step that an option is; nothing where it is none.
std::optional<Transform> step_of(const std::string& option, CommandArguments& arguments) {
  if (option == "-t") {
    const double x = arguments.number(), y = arguments.number(), z = arguments.number();
    return Transform::translate({x, y, z});
  }
  if (option == "-s") {
    const double factor = arguments.number();
    if (factor == 0) arguments.refuse("'-s' scales by zero");
    return Transform::scale({factor, factor, factor});
  }
  const bool turns = option.starts_with("-r"), mirrors = option.starts_with("-m");
  if (option.size() != 3 || (!turns && !mirrors) || option[2] < 'x' || option[2] > 'z')
    return std::nullopt;
  Vec3d axis(0, 0, 0);
  axis[option[2] - 'x'] = 1;
  if (turns) return Transform::rotate(axis, arguments.number());
  return Transform::scale(Vec3d(1, 1, 1) - axis * 2.0);
}

/// All copies: of each group in turn, the later ones placed behind the earlier.
std::vector<Transform> placements_of(const std::vector<Group>& groups,
                                     const CommandArguments& arguments) {
  std::vector<Transform> placements(1);
  for (const Group& group : groups) {
    if (!group.is_array) {
      const Transform all = power(group.once, group.times);
      for (Transform& placement : placements) placement = all * placement;
      continue;
    }
    if (group.times > most_placements / placements.size())
      arguments.refuse(fmt::format("'xform' makes more than {} copies", most_placements));
    std::vector<Transform> copies;
    copies.reserve(placements.size() * group.times);
    Transform step;
    for (size_t i = 0; i < group.times; ++i, step = group.once * step)
      for (const Transform& placement : placements) copies.push_back(step * placement);
    placements = std::move(copies);
  }
  return placements;
}

Placing read_arguments(const Words& words, const Place& place) {
  Placing placing;
  CommandArguments arguments(words, xform_usage, place);
  std::vector<Group> groups(1);
  while (arguments.at_option()) {
    const std::string option = arguments.text();
    if (option == "-a" || option == "-i") {
      groups.push_back({arguments.count(most_placements), option == "-a", {}});
    } else if (const auto step = step_of(option, arguments)) {
      groups.back().once = *step * groups.back().once;
    } else if (option == "-m") {
      const std::string modifier = arguments.text();
      if (!placing.modifier) placing.modifier = modifier;
    } else if (option == "-n") {
      arguments.text();
    } else if (option == "-I") {
      placing.is_inverted = !placing.is_inverted;
    } else if (option != "-c" && option != "-e") {
      arguments.refuse(fmt::format("'xform' has no option '{}'", option.substr(0, 40)));
    }
  }
  placing.placements = placements_of(groups, arguments);
  while (!arguments.at_end()) placing.files.push_back(arguments.text());
  if (placing.files.empty()) placing.files.push_back("");
  return placing;
}

}  // namespace

Vec3d placed_point(const Transform& t, const Vec3d& p) {
  const auto row = [&](int i) {
    return t.at(i, 0) * p.x + t.at(i, 1) * p.y + t.at(i, 2) * p.z + t.at(i, 3);
  };
  return {row(0), row(1), row(2)};
}

Vec3d placed_vector(const Transform& t, const Vec3d& v) {
  const auto row = [&](int i) { return t.at(i, 0) * v.x + t.at(i, 1) * v.y + t.at(i, 2) * v.z; };
  return {row(0), row(1), row(2)};
}

double scale_of(const Transform& transform) {
  return std::cbrt(std::fabs(transform.determinant3()));
}

Placing read_xform(const Words& words, const Place& place, const ArgumentLines& lines_of) {
  const auto file = std::find(words.begin(), words.end(), "-f");
  try {
    if (file == words.end()) return read_arguments(words, place);
    if (words.end() - file < 2)
      CommandArguments(words, xform_usage, place).refuse("'-f' lacks the name of a file");
    Placing all;
    for (const std::string& line : lines_of(file[1])) {
      Words placed(words.begin(), file);
      std::string_view rest = line;
      for (auto word = next_word(rest); !word.empty(); word = next_word(rest))
        if (word != "!xform" && word != "xform") placed.emplace_back(word);
      placed.insert(placed.end(), file + 2, words.end());
      const Placing one = read_arguments(placed, place);
      if (all.placements.size() + one.placements.size() > most_placements)
        CommandArguments(words, xform_usage, place).refuse("'-f' makes too many copies");
      if (all.files.empty()) {
        all = one;
      } else {
        all.placements.insert(all.placements.end(), one.placements.begin(), one.placements.end());
      }
    }
    return all;
  } catch (const std::invalid_argument&) {
    CommandArguments(words, xform_usage, place)
        .refuse("the transform of 'xform' is too large, or collapses space");
  }
}

std::optional<Transform> transform_in(std::span<const std::string> strings) {
  if (strings.empty()) return Transform();
  Words words = {"xform"};
  words.insert(words.end(), strings.begin(), strings.end());
  try {
    const Placing placing = read_arguments(words, {});
    return placing.placements.size() == 1 && placing.files.front().empty()
               ? std::optional(placing.placements.front())
               : std::nullopt;
  } catch (const std::exception&) {
    return std::nullopt;
  }
}

}  // namespace kaustik::radiance
