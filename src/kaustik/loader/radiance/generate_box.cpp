// genbox and genprism.

#include <algorithm>
#include <array>
#include <cmath>

#include "kaustik/base/text_lines.h"
#include "kaustik/loader/radiance/generators.h"
#include "kaustik/loader/radiance/number_text.h"
#include "kaustik/loader/radiance/primitive_writer.h"

namespace kaustik::radiance {
namespace {

/// A box from the origin to `size`, with edges that are bevelled or rounded by `radius`.
class Box {
 public:
  Box(std::string modifier, std::string id, const Vec3d& size, double radius, bool is_inward,
      Place place)
      : modifier_(std::move(modifier)),
        id_(std::move(id)),
        size_(size),
        radius_(radius),
        is_inward_(is_inward),
        writer_(std::move(place)) {}

  std::string write(bool is_rounded) {
    for (int axis = 0; axis < 3; ++axis)
      for (const bool high : {false, true}) add_face(axis, high);
    if (radius_ > 0)
      for (int axis = 0; axis < 3; ++axis)
        for (int corner = 0; corner < 4; ++corner)
          add_edge(axis, (corner & 1) != 0, (corner & 2) != 0, is_rounded);
    if (radius_ > 0)
      for (int corner = 0; corner < 8; ++corner) add_corner(corner, is_rounded);
    return writer_.take();
  }

 private:
  double end(int axis, bool high, double inset) const { return high ? size_[axis] - inset : inset; }
  /// The name has a number.
  void add_polygon(std::vector<Vec3d> corners, const Vec3d& outward) {
    const Vec3d normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    if ((normal.dot(outward) < 0) != is_inward_) std::reverse(corners.begin(), corners.end());
    writer_.polygon(modifier_, next_name(), corners);
  }
  std::string next_name() { return fmt::format("{}.{}", id_, ++count_); }

  void add_face(int axis, bool high) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    std::vector<Vec3d> corners(4);
    for (int i = 0; i < 4; ++i) {
      corners[size_t(i)][axis] = end(axis, high, 0);
      corners[size_t(i)][u] = end(u, i == 1 || i == 2, radius_);
      corners[size_t(i)][v] = end(v, i >= 2, radius_);
    }
    Vec3d outward(0, 0, 0);
    outward[axis] = high ? 1 : -1;
    add_polygon(std::move(corners), outward);
  }

  /// Along `axis`, where the other two axes are at their ends.
  void add_edge(int axis, bool high_u, bool high_v, bool is_rounded) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    const auto point = [&](bool far, double inset_u, double inset_v) {
      Vec3d p(0, 0, 0);
      p[axis] = end(axis, far, radius_);
      p[u] = end(u, high_u, inset_u);
      p[v] = end(v, high_v, inset_v);
      return p;
    };
    if (is_rounded) {
      const Vec3d a = point(false, radius_, radius_), b = point(true, radius_, radius_);
      writer_.add(modifier_, is_inward_ ? "tube" : "cylinder", next_name(),
                  {a.x, a.y, a.z, b.x, b.y, b.z, radius_});
      return;
    }
    Vec3d outward(0, 0, 0);
    outward[u] = high_u ? 1 : -1;
    outward[v] = high_v ? 1 : -1;
    add_polygon({point(false, 0, radius_), point(true, 0, radius_), point(true, radius_, 0),
                 point(false, radius_, 0)},
                outward);
  }

  void add_corner(int corner, bool is_rounded) {
    Vec3d centre, outward;
    for (int axis = 0; axis < 3; ++axis) {
      const bool high = (corner >> axis & 1) != 0;
      centre[axis] = end(axis, high, radius_);
      outward[axis] = high ? 1 : -1;
    }
    if (is_rounded) {
      writer_.add(modifier_, is_inward_ ? "bubble" : "sphere", next_name(),
                  {centre.x, centre.y, centre.z, radius_});
      return;
    }
    std::vector<Vec3d> corners(3, centre);
    for (int axis = 0; axis < 3; ++axis) corners[size_t(axis)][axis] += radius_ * outward[axis];
    add_polygon(std::move(corners), outward);
  }

  std::string modifier_, id_;
  Vec3d size_;
  double radius_;
  bool is_inward_;
  int count_ = 0;
  PrimitiveWriter writer_;
};

constexpr size_t most_prism_corners = 100'000;

std::vector<Vec3d> prism_outline(CommandArguments& arguments, const GeneratorContext& context) {
  std::vector<Vec3d> outline;
  const std::string first = arguments.text();
  if (const auto number = number_of(first)) {
    if (!(*number >= 3 && *number <= double(most_prism_corners)))
      arguments.refuse("'genprism' has too few or too many corners");
    for (auto left = size_t(*number); left > 0; --left) {
      const double x = arguments.number();
      outline.emplace_back(x, arguments.number(), 0);
    }
    return outline;
  }
  if (first == "-") arguments.refuse("'genprism -' reads what is typed");
  const std::string text = context.read(first);
  std::string words = text;
  std::replace(words.begin(), words.end(), '\n', ' ');
  std::string_view rest = words;
  for (auto word = next_word(rest); !word.empty(); word = next_word(rest)) {
    const auto x = number_of(word), y = number_of(next_word(rest));
    if (!x || !y) break;
    outline.emplace_back(*x, *y, 0);
  }
  if (outline.size() < 3) arguments.refuse("the file of 'genprism' has too few corners");
  return outline;
}

}  // namespace

std::string generate_box(const Words& words, const GeneratorContext& context) {
  CommandArguments arguments(words, "genbox material name x y z [-i] [-b bevel | -r radius]",
                             context.place);
  const std::string modifier = arguments.text(), id = arguments.text();
  const double x = arguments.number(), y = arguments.number(), z = arguments.number();
  if (!(x > 0 && y > 0 && z > 0)) arguments.refuse("a size of 'genbox' is not above zero");
  double radius = 0;
  bool is_rounded = false, is_inward = false;
  while (!arguments.at_end()) {
    const std::string option = arguments.text();
    if (option == "-i") {
      is_inward = true;
    } else if (option == "-b" || option == "-r") {
      is_rounded = option == "-r";
      radius = arguments.number();
      if (!(radius > 0 && 2 * radius <= std::min({x, y, z})))
        arguments.refuse("the radius of 'genbox' does not fit the box");
    } else if (option == "-n") {
      arguments.number();  // how many facets: cylinders and spheres are round here
    } else if (option != "-s") {
      arguments.refuse(fmt::format("'genbox' has no option '{}'", option.substr(0, 40)));
    }
  }
  return Box(modifier, id, {x, y, z}, radius, is_inward, context.place).write(is_rounded);
}

std::string generate_prism(const Words& words, const GeneratorContext& context) {
  CommandArguments arguments(
      words, "genprism material name N x1 y1 … xN yN [-l x y z] [-c] [-e], or a file for N …",
      context.place);
  const std::string modifier = arguments.text(), id = arguments.text();
  const std::vector<Vec3d> outline = prism_outline(arguments, context);
  Vec3d along(0, 0, 1);
  bool has_ends = true, is_complete = false;
  while (!arguments.at_end()) {
    const std::string option = arguments.text();
    if (option == "-l") {
      for (int i = 0; i < 3; ++i) along[i] = arguments.number();
      if (along.z == 0) arguments.refuse("'genprism' extrudes within its plane");
    } else if (option == "-r") {
      if (arguments.number() > 0)
        context.deviations.approximated(fmt::format("genprism '{}'", id),
                                        "its rounded edges are sharp", context.place);
    } else if (option == "-e") {
      has_ends = !has_ends;
    } else if (option == "-c") {
      is_complete = !is_complete;
    } else {
      arguments.refuse(fmt::format("'genprism' has no option '{}'", option.substr(0, 40)));
    }
  }
  PrimitiveWriter writer(context.place);
  const size_t n = outline.size();
  if (has_ends) {
    writer.polygon(modifier, id + ".b", outline);
    std::vector<Vec3d> top(outline.rbegin(), outline.rend());
    for (Vec3d& p : top) p += along;
    writer.polygon(modifier, id + ".t", top);
  }
  for (size_t i = 0; i < (is_complete ? n - 1 : n); ++i) {
    const Vec3d &a = outline[i], &b = outline[(i + 1) % n];
    writer.polygon(modifier, fmt::format("{}.{}", id, i + 1),
                   std::array{a, a + along, b + along, b});
  }
  return writer.take();
}

}  // namespace kaustik::radiance
