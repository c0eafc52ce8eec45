// genrev, genworm and gensurf: shapes by functions.

#include <algorithm>
#include <array>
#include <cmath>

#include "kaustik/loader/radiance/cal_evaluator.h"
#include "kaustik/loader/radiance/generators.h"
#include "kaustik/loader/radiance/primitive_writer.h"

namespace kaustik::radiance {
namespace {

constexpr size_t most_segments = 20'000, most_facets = 100'000;

/// The functions that the arguments of a program define, and its options -e and -f.
class CurveFunctions {
 public:
  CurveFunctions(CommandArguments& arguments, const GeneratorContext& context)
      : arguments_(arguments), context_(context) {
    program_.add("PI : 3.14159265358979323846;");
  }

  /// `name(parameters)` is the expression.
  void define(const std::string& name, const std::string& parameters,
              const std::string& expression) {
    later_ += fmt::format("{}({}) = {};\n", name, parameters, expression);
  }
  /// True if it was one of those.
  bool take_option(const std::string& option) {
    if (option != "-e" && option != "-f") return false;
    const std::string what = arguments_.text();
    guard([&] { program_.add(option == "-e" ? what : context_.read(what)); });
    return true;
  }
  void ready() {
    guard([&] { program_.add(later_); });
  }
  size_t count_of(const std::string& expression, size_t most) {
    double value = 0;
    guard([&] {
      const uint32_t root = program_.add_expression(expression);
      value = std::floor(CalEvaluator(program_).value(root) + 0.5);
    });
    if (!(value >= 1 && value <= double(most)))
      arguments_.refuse(fmt::format("the number of segments is not between 1 and {}", most));
    return size_t(value);
  }
  bool has(const std::string& name) {
    return program_.definition_of(program_.symbol_of(name)) != nullptr;
  }
  double at(const char* name, std::initializer_list<double> parameters) {
    double value = 0;
    guard([&] {
      if (!evaluator_) evaluator_.emplace(program_);
      value = evaluator_->call(name, std::span(parameters.begin(), parameters.size()));
    });
    if (!std::isfinite(value) || std::fabs(value) > 1e12)
      arguments_.refuse(fmt::format("a function of '{}' has no finite value", arguments_.name()));
    return value;
  }

 private:
  template <typename Work>
  void guard(const Work& work) const {
    try {
      work();
    } catch (const CalError& error) {
      arguments_.refuse(fmt::format("a function of '{}': {}", arguments_.name(), error.what()));
    }
  }

  CommandArguments& arguments_;
  const GeneratorContext& context_;
  CalProgram program_;
  std::string later_;
  std::optional<CalEvaluator> evaluator_;
};

/// What all of these programs begin by: a modifier, a name, functions, numbers of segments,
/// options.
struct CurveCommand {
  /// Functions of those names and parameters; so many numbers of segments; options that set a flag.
  CurveCommand(const Words& words, const GeneratorContext& context, const char* usage,
               std::initializer_list<const char*> names, const char* parameters, size_t counts,
               std::initializer_list<std::pair<std::string_view, bool*>> flags)
      : arguments(words, usage, context.place),
        functions(arguments, context),
        modifier(arguments.text()),
        id(arguments.text()) {
    for (const char* name : names) functions.define(name, parameters, arguments.text());
    while (counts_.size() < counts) counts_.push_back(arguments.text());
    while (!arguments.at_end()) {
      const std::string option = arguments.text();
      const auto flag =
          std::ranges::find(flags, option, &std::pair<std::string_view, bool*>::first);
      if (flag != flags.end())
        *flag->second = true;
      else if (!functions.take_option(option))
        arguments.refuse(
            fmt::format("'{}' has no option '{}'", arguments.name(), option.substr(0, 40)));
    }
    functions.ready();
  }
  CurveCommand(const CurveCommand&) = delete;
  CurveCommand& operator=(const CurveCommand&) = delete;

  size_t count(size_t which, size_t most) { return functions.count_of(counts_[which], most); }

  CommandArguments arguments;
  CurveFunctions functions;
  std::string modifier, id;

 private:
  std::vector<std::string> counts_;
};

/// One segment of a body of revolution about z, from (z0, r0) to (z1, r1); its front is to the
/// outside where z grows.
void add_revolved(PrimitiveWriter& writer, const std::string& modifier, const std::string& id,
                  double z0, double r0, double z1, double r1) {
  constexpr double tiny = 1e-9;
  const bool is_level = std::fabs(z1 - z0) <= tiny, is_even = std::fabs(r1 - r0) <= tiny;
  if (is_level && is_even) return;
  if (is_level)
    writer.add(modifier, "ring", id, {0, 0, z1, 0, 0, r1 < r0 ? 1.0 : -1.0, r0, r1});
  else if (is_even)
    writer.add(modifier, z1 < z0 ? "tube" : "cylinder", id, {0, 0, z0, 0, 0, z1, r1});
  else
    writer.add(modifier, z1 < z0 ? "cup" : "cone", id, {0, 0, z0, 0, 0, z1, r0, r1});
}

/// A point of a surface by two parameters.
struct GridPoint {
  bool is_there = true;
  Vec3d p, normal;
};

/// Writes the facets between two rows of a gensurf surface.
class FacetWriter {
 public:
  FacetWriter(std::string modifier, std::string id, bool is_smooth, bool is_reversed, Place place)
      : modifier_(std::move(modifier)),
        id_(std::move(id)),
        is_smooth_(is_smooth),
        is_reversed_(is_reversed),
        writer_(std::move(place)) {}

  void triangle(const GridPoint& a, const GridPoint& b, const GridPoint& c) {
    if (!a.is_there || !b.is_there || !c.is_there) return;
    const GridPoint *second = is_reversed_ ? &c : &b, *third = is_reversed_ ? &b : &c;
    if ((second->p - a.p).cross(third->p - a.p).length() == 0) return;
    std::string modifier = modifier_;
    if (is_smooth_) {
      // Kaustik's own: the normals at the corners, where Radiance has a texture for each facet.
      writer_.line(fmt::format("{} texfunc {}", modifier_, smooth_name_));
      std::string reals;
      for (const GridPoint* corner : {&a, second, third}) {
        const Vec3d n = is_reversed_ ? -corner->normal : corner->normal;
        reals += fmt::format(" {} {} {}", n.x, n.y, n.z);
      }
      writer_.line("4 corner_dx corner_dy corner_dz corner_normals\n0\n9" + reals);
      modifier = smooth_name_;
    }
    writer_.polygon(modifier, fmt::format("{}.{}", id_, ++count_),
                    std::array{a.p, second->p, third->p});
  }
  std::string take() { return writer_.take(); }

 private:
  static constexpr const char* smooth_name_ = "Phong";
  std::string modifier_, id_;
  bool is_smooth_, is_reversed_;
  size_t count_ = 0;
  PrimitiveWriter writer_;
};

/// By the neighbours on both sides; of parameters (s, t) the first cross the second.
void add_normals(std::vector<std::vector<GridPoint>>& grid) {
  const size_t rows = grid.size(), columns = grid[0].size();
  for (size_t i = 0; i < rows; ++i)
    for (size_t j = 0; j < columns; ++j) {
      const auto difference = [&](size_t i0, size_t j0, size_t i1, size_t j1) {
        const GridPoint &low = grid[i0][j0], &high = grid[i1][j1], &own = grid[i][j];
        return (high.is_there ? high.p : own.p) - (low.is_there ? low.p : own.p);
      };
      const Vec3d along_s = difference(i > 0 ? i - 1 : 0, j, std::min(i + 1, rows - 1), j);
      const Vec3d along_t = difference(i, j > 0 ? j - 1 : 0, i, std::min(j + 1, columns - 1));
      grid[i][j].normal = along_s.cross(along_t).normalized();
    }
}

}  // namespace

std::string generate_revolution(const Words& words, const GeneratorContext& context) {
  bool is_smooth = false;
  CurveCommand command(words, context,
                       "genrev material name 'z(t)' 'r(t)' segments [-e expression] [-f file] [-s]",
                       {"Z`SYS", "R`SYS"}, "t", 1, {{"-s", &is_smooth}});
  if (is_smooth)
    context.deviations.approximated(fmt::format("genrev '{}'", command.id),
                                    "its segments are smooth around, but not along it",
                                    context.place);
  CurveFunctions& functions = command.functions;
  const size_t segments = command.count(0, most_segments);
  PrimitiveWriter writer(context.place);
  double z = functions.at("Z`SYS", {0}), r = functions.at("R`SYS", {0});
  for (size_t i = 1; i <= segments; ++i) {
    const double t = double(i) / double(segments);
    const double next_z = functions.at("Z`SYS", {t}), next_r = functions.at("R`SYS", {t});
    add_revolved(writer, command.modifier, fmt::format("{}.{}", command.id, i), z, r, next_z,
                 next_r);
    z = next_z;
    r = next_r;
  }
  return writer.take();
}

std::string generate_worm(const Words& words, const GeneratorContext& context) {
  CurveCommand command(words, context,
                       "genworm material name 'x(t)' 'y(t)' 'z(t)' 'r(t)' segments "
                       "[-e expression] [-f file]",
                       {"X`SYS", "Y`SYS", "Z`SYS", "R`SYS"}, "t", 1, {});
  CurveFunctions& functions = command.functions;
  const std::string &modifier = command.modifier, &id = command.id;
  const size_t segments = command.count(0, most_segments);
  PrimitiveWriter writer(context.place);
  Vec3d last;
  double last_r = 0;
  for (size_t i = 0; i <= segments; ++i) {
    const double t = double(i) / double(segments);
    const Vec3d p(functions.at("X`SYS", {t}), functions.at("Y`SYS", {t}),
                  functions.at("Z`SYS", {t}));
    const double r = functions.at("R`SYS", {t});
    if (i > 0 && std::fabs(r - last_r) <= 1e-6) {
      writer.add(modifier, "cylinder", fmt::format("{}.c{}", id, i),
                 {last.x, last.y, last.z, p.x, p.y, p.z, r});
    } else if (i > 0 && (p - last).length2() > 0) {
      // The cone that touches both spheres.
      const double f = (last_r - r) / (p - last).length2();
      const Vec3d a = last + (p - last) * (f * last_r), b = p + (p - last) * (f * r);
      const double shrink = std::sqrt(std::max(0.0, 1 - (last_r - r) * f));
      writer.add(modifier, "cone", fmt::format("{}.c{}", id, i),
                 {a.x, a.y, a.z, b.x, b.y, b.z, shrink * last_r, shrink * r});
    }
    writer.add(modifier, "sphere", fmt::format("{}.s{}", id, i), {p.x, p.y, p.z, r});
    last = p;
    last_r = r;
  }
  return writer.take();
}

std::string generate_surface(const Words& words, const GeneratorContext& context) {
  bool is_smooth = false, is_reversed = false;
  CurveCommand command(words, context,
                       "gensurf material name 'x(s,t)' 'y(s,t)' 'z(s,t)' m n "
                       "[-s] [-i] [-e expression] [-f file]",
                       {"X`SYS", "Y`SYS", "Z`SYS"}, "s, t", 2,
                       {{"-s", &is_smooth}, {"-i", &is_reversed}});
  CurveFunctions& functions = command.functions;
  const size_t m = command.count(0, most_facets), n = command.count(1, most_facets / m);
  const bool is_partial = functions.has("valid");
  std::vector grid(m + 1, std::vector<GridPoint>(n + 1));
  for (size_t i = 0; i <= m; ++i)
    for (size_t j = 0; j <= n; ++j) {
      const double s = double(i) / double(m), t = double(j) / double(n);
      GridPoint& point = grid[i][j];
      point.is_there = !is_partial || functions.at("valid", {s, t}) > 0;
      if (point.is_there)
        point.p = {functions.at("X`SYS", {s, t}), functions.at("Y`SYS", {s, t}),
                   functions.at("Z`SYS", {s, t})};
    }
  if (is_smooth) add_normals(grid);
  FacetWriter writer(command.modifier, command.id, is_smooth, is_reversed, context.place);
  for (size_t i = 0; i < m; ++i)
    for (size_t j = 0; j < n; ++j) {
      const GridPoint &a = grid[i][j], &b = grid[i + 1][j], &c = grid[i + 1][j + 1],
                      &d = grid[i][j + 1];
      const bool by_other = j % 2 == 1 ? b.is_there && d.is_there : !(a.is_there && c.is_there);
      if (by_other) {
        writer.triangle(a, b, d);
        writer.triangle(b, c, d);
      } else {
        writer.triangle(a, b, c);
        writer.triangle(a, c, d);
      }
    }
  return writer.take();
}

}  // namespace kaustik::radiance
