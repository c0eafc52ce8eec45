#include "kaustik/loader/radiance/patterns.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "kaustik/base/error.h"
#include "kaustik/loader/radiance/cal_functions.h"
#include "kaustik/loader/radiance/data_table.h"
#include "kaustik/loader/radiance/pattern_functions.h"
#include "kaustik/loader/radiance/sky_models.h"

namespace kaustik::radiance {
namespace {

namespace fs = std::filesystem;

using FunctionsPointer = std::unique_ptr<PatternFunctions>;

/// brightfunc, colorfunc and the numbers of mixfunc.
class FunctionPattern final : public Pattern {
 public:
  FunctionPattern(FunctionsPointer functions, size_t channels)
      : functions_(std::move(functions)), channels_(channels) {}
  Rgb at(const PatternPoint& point) const override {
    functions_->stand_at(point);
    const double first = functions_->value(0);
    if (channels_ == 1) return {first, first, first};
    return {first, functions_->value(1), functions_->value(2)};
  }

 private:
  FunctionsPointer functions_;
  size_t channels_;
};

/// brightdata and colordata.
class DataPattern final : public Pattern {
 public:
  DataPattern(FunctionsPointer functions, std::vector<std::string> names,
              std::vector<DataTable> tables)
      : functions_(std::move(functions)), names_(std::move(names)), tables_(std::move(tables)) {}

  Rgb at(const PatternPoint& point) const override {
    functions_->stand_at(point);
    std::vector<double> place;
    for (size_t i = 0; i < tables_[0].dimensions(); ++i) place.push_back(functions_->value(i));
    std::array<double, 3> found{};
    for (size_t i = 0; i < tables_.size(); ++i) found[i] = tables_[i].at(place);
    if (tables_.size() == 1) {
      const double value = functions_->call(names_[0], std::span(found.data(), 1));
      return {value, value, value};
    }
    return {functions_->call(names_[0], found), functions_->call(names_[1], found),
            functions_->call(names_[2], found)};
  }

 private:
  FunctionsPointer functions_;
  std::vector<std::string> names_;
  std::vector<DataTable> tables_;
};

class SkyPattern final : public Pattern {
 public:
  SkyPattern(const SkyModel& model, const Transform& world_from_own)
      : model_(model), own_from_world_(world_from_own.inverse()) {}
  Rgb at(const PatternPoint& point) const override {
    const double value =
        model_.radiance(placed_vector(own_from_world_, point.direction).normalized());
    return {value, value, value};
  }
  bool is_quick() const override { return true; }

 private:
  SkyModel model_;
  Transform own_from_world_;
};

class ConstantPattern final : public Pattern {
 public:
  explicit ConstantPattern(const Rgb& colour) : colour_(colour) {}
  Rgb at(const PatternPoint&) const override { return colour_; }
  bool is_quick() const override { return true; }

 private:
  Rgb colour_;
};

class FunctionPicture final : public PicturePattern {
 public:
  FunctionPicture(std::string file, FunctionsPointer functions)
      : PicturePattern(std::move(file)), functions_(std::move(functions)) {}
  std::pair<double, double> place_of(const PatternPoint& point) const override {
    functions_->stand_at(point);
    const double u = functions_->value(0);
    return {u, functions_->value(1)};
  }

 private:
  FunctionsPointer functions_;
};

/// Of a spectrum by even steps from `first` to `last`, nm: means over the thirds of what is seen.
Rgb thirds_of(std::span<const double> values, double first, double last) {
  constexpr double bounds[4] = {400, 500, 600, 700};
  double sums[3] = {}, counts[3] = {};
  constexpr int steps = 300;
  for (int i = 0; i < steps; ++i) {
    const double nm = bounds[0] + (bounds[3] - bounds[0]) * (i + 0.5) / steps;
    const double at =
        std::clamp((nm - first) / (last - first), 0.0, 1.0) * double(values.size() - 1);
    const auto low = std::min(size_t(at), values.size() - 2);
    const int third = nm < bounds[1] ? 2 : nm < bounds[2] ? 1 : 0;
    sums[third] += values[low] + (values[low + 1] - values[low]) * (at - double(low));
    ++counts[third];
  }
  return {sums[0] / counts[0], sums[1] / counts[1], sums[2] / counts[2]};
}

/// World from the space of a modifier whose strings from `first` on are a transform.
Transform world_from(const Modifier& modifier, size_t first) {
  const auto& strings = modifier.strings();
  const auto own = transform_in(std::span(strings).subspan(std::min(first, strings.size())));
  if (!own) throw CalError("the transform at the end of its strings is wrong");
  return modifier.placed * *own;
}

fs::path folder_of(const Modifier& modifier) {
  return modifier.place().file ? fs::path(*modifier.place().file).parent_path() : fs::path();
}

void need_strings(const Modifier& modifier, size_t least) {
  if (modifier.strings().size() < least)
    throw CalError(fmt::format("it has {} strings where at least {} are needed",
                               modifier.strings().size(), least));
}

/// Where the name of the file of functions stands among the strings of a type.
size_t function_file_of(const std::string& type) {
  if (type == "brightfunc") return 1;
  if (type == "colorfunc" || type == "mixfunc") return 3;
  return type == "brightdata" ? 2 : type == "colordata" ? 6 : 4;
}

}  // namespace

std::optional<std::string> PatternReader::text_for(const std::string& name,
                                                   const Modifier& modifier) {
  const auto path = files_.find(name, folder_of(modifier), modifier.place());
  if (!path) return std::nullopt;
  return files_.text_of(*path, modifier.place());
}

std::string PatternReader::function_source(const std::string& name, const Modifier& modifier) {
  if (name == "." || name == "rayinit.cal") return "";
  if (auto text = text_for(name, modifier)) return *text;
  const std::string_view built_in = cal_library_file(fs::path(name).filename().string());
  if (built_in.empty())
    throw MissingFile(fmt::format("there is no file '{}' of functions, and none is built in",
                                  name.substr(0, 100)));
  return std::string(built_in);
}

void PatternReader::tell_left_out(const char* what, const CalError& why, const Modifier& modifier) {
  const bool is_missing = dynamic_cast<const MissingFile*>(&why) != nullptr;
  deviations_.add(is_missing ? DeviationKind::missing : DeviationKind::ignored,
                  name_of(*modifier.primitive),
                  fmt::format("the {} is left out: {}", what, why.what()), modifier.place());
}

std::shared_ptr<const Pattern> PatternReader::pattern(const Modifier& modifier) {
  const auto [entry, is_new] = patterns_.try_emplace(&modifier);
  if (!is_new) return entry->second;
  try {
    entry->second = read_pattern(modifier);
  } catch (const CalError& error) {
    tell_left_out("pattern", error, modifier);
  }
  return entry->second;
}

std::shared_ptr<const Pattern> PatternReader::read_pattern(const Modifier& modifier) {
  const std::string& type = modifier.type();
  const auto& strings = modifier.strings();
  if (type == "spectrum" || type == "specfile") return read_spectrum(modifier);
  if (type == "brighttext" || type == "colortext") {
    const size_t first = type == "brighttext" ? 10 : 12;
    if (modifier.reals().size() < first + (type == "brighttext" ? 1u : 3u))
      throw CalError("it has too few numbers");
    const double* ground = &modifier.reals()[first];
    deviations_.approximated(name_of(*modifier.primitive), "its letters are left out",
                             modifier.place());
    return std::make_shared<ConstantPattern>(type == "brighttext"
                                                 ? Rgb{ground[0], ground[0], ground[0]}
                                                 : Rgb{ground[0], ground[1], ground[2]});
  }
  if (type == "specfunc" || type == "specdata" || type == "specpict")
    throw CalError("patterns over wavelength are not known here");
  const size_t file = function_file_of(type);
  need_strings(modifier, file + 1);
  if (type == "brightfunc") {
    const Transform placed = world_from(modifier, 2);
    if (const auto sky = SkyModel::of(strings[0], strings[1], modifier.reals()))
      return std::make_shared<SkyPattern>(*sky, placed);
  }
  const std::string source = function_source(strings[file], modifier);
  if (type == "brightfunc" || type == "colorfunc" || type == "mixfunc") {
    const size_t first = type == "mixfunc" ? 2 : 0, count = file - first;
    return std::make_shared<FunctionPattern>(
        std::make_unique<PatternFunctions>(source, std::span(strings).subspan(first, count),
                                           modifier.reals(), world_from(modifier, file + 1)),
        count);
  }
  const size_t first = type == "mixdata" ? 2 : 0, count = type == "colordata" ? 3 : 1;
  std::vector<DataTable> tables;
  for (size_t i = 0; i < count; ++i) {
    const std::string& name = strings[first + count + i];
    const auto text = text_for(name, modifier);
    if (!text) throw MissingFile(fmt::format("there is no file '{}' of data", name.substr(0, 100)));
    tables.emplace_back(*text);
    if (tables.back().dimensions() != tables[0].dimensions())
      throw CalError("its tables have different dimensions");
  }
  const size_t dimensions = tables[0].dimensions();
  need_strings(modifier, file + 1 + dimensions);
  return std::make_shared<DataPattern>(
      std::make_unique<PatternFunctions>(source, std::span(strings).subspan(file + 1, dimensions),
                                         modifier.reals(),
                                         world_from(modifier, file + 1 + dimensions)),
      std::vector(strings.begin() + ptrdiff_t(first), strings.begin() + ptrdiff_t(first + count)),
      std::move(tables));
}

std::shared_ptr<const Pattern> PatternReader::read_spectrum(const Modifier& modifier) {
  const auto& reals = modifier.reals();
  if (modifier.type() == "specfile") {
    need_strings(modifier, 1);
    const std::string& name = modifier.strings()[0];
    if (!files_.find(name, folder_of(modifier), modifier.place()))
      throw MissingFile(fmt::format("there is no file '{}' of a spectrum", name.substr(0, 100)));
    throw CalError("spectra in files are not known here");
  }
  if (reals.size() < 5 || !(reals[0] != reals[1]))
    throw CalError("only spectra with at least three values of their own are known here");
  deviations_.approximated(name_of(*modifier.primitive),
                           "the spectrum counts by its means over red, green and blue",
                           modifier.place());
  return std::make_shared<ConstantPattern>(
      thirds_of(std::span(reals).subspan(2), reals[0], reals[1]));
}

std::shared_ptr<const PicturePattern> PatternReader::picture(const Modifier& modifier) {
  const auto [entry, is_new] = pictures_.try_emplace(&modifier);
  if (!is_new) return entry->second;
  try {
    entry->second = read_picture(modifier);
  } catch (const CalError& error) {
    tell_left_out("picture", error, modifier);
  }
  return entry->second;
}

std::shared_ptr<const PicturePattern> PatternReader::read_picture(const Modifier& modifier) {
  // Three functions of the colour, or two modifiers and one of the weight; then these.
  const size_t file = 3;
  need_strings(modifier, file + 4);
  const auto& strings = modifier.strings();
  const auto picture = files_.find(strings[file], folder_of(modifier), modifier.place());
  if (!picture)
    deviations_.missing(name_of(*modifier.primitive),
                        fmt::format("there is no picture '{}'", strings[file].substr(0, 100)),
                        modifier.place());
  std::vector<std::string> coordinates = {strings[file + 2], strings[file + 3]};
  // Tiles are what is left of even coordinates, which the texture does by itself.
  const bool repeats = coordinates[0] == "tile_u" && coordinates[1] == "tile_v";
  if (repeats) coordinates = {"pic_u", "pic_v"};
  auto made = std::make_shared<FunctionPicture>(
      picture ? picture->string() : std::string(),
      std::make_unique<PatternFunctions>(function_source(strings[file + 1], modifier),
                                         std::span<const std::string>(coordinates),
                                         modifier.reals(), world_from(modifier, file + 4)));
  made->repeats = repeats;
  return made;
}

}  // namespace kaustik::radiance
