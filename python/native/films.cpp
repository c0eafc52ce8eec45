// Films: exact sums of passes, with all that they are a function of.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "bind.h"
#include "films.h"
#include "kaustik/base/version.h"
#include "kaustik/render/checkpoint_merge.h"
#include "kaustik/render/finished_picture.h"
#include "kaustik/render/program_version.h"

namespace kaustik::python {
namespace {

constexpr const char* from_memory = "film";

py::bytes bytes_of(const KeptFilm& film) {
  std::vector<uint8_t> bytes;
  {
    const py::gil_scoped_release released;
    const Checkpoint& kept = *film.checkpoint;
    bytes = checkpoint_bytes(kept.record, kept.film, kept.lessons);
  }
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

KeptFilm checked(Checkpoint checkpoint, const std::string& name) {
  check_program(name, checkpoint.record.program, KAUSTIK_VERSION);
  return {std::make_shared<const Checkpoint>(std::move(checkpoint))};
}

KeptFilm parsed_film(const py::bytes& bytes) {
  const std::string_view view = bytes;
  const py::gil_scoped_release released;
  return checked(parse_checkpoint({view.begin(), view.end()}, from_memory), from_memory);
}

KeptFilm read_film(const std::string& path) {
  const py::gil_scoped_release released;
  return checked(read_checkpoint(path), path);
}

void write_film(const KeptFilm& film, const std::string& path) {
  const py::gil_scoped_release released;
  write_checkpoint(path, film.checkpoint->record, film.checkpoint->film, film.checkpoint->lessons);
}

KeptFilm sum(const KeptFilm& a, const KeptFilm& b) {
  const py::gil_scoped_release released;
  Checkpoint whole = *a.checkpoint;
  merge_checkpoint(whole, "the film on the left", *b.checkpoint, "the film on the right");
  return {std::make_shared<const Checkpoint>(std::move(whole))};
}

bool equal(const KeptFilm& a, const KeptFilm& b) {
  const py::gil_scoped_release released;
  return a.checkpoint == b.checkpoint || a.sums() == b.sums();
}

Image image(const KeptFilm& film) {
  const py::gil_scoped_release released;
  const Checkpoint& kept = *film.checkpoint;
  return finished_picture(kept.film.image(), kept.record, PictureFacts::of(kept.film), {});
}

/// Mean, standard error, bias, degrees of freedom (0 where the standard error is not known),
/// standard error of the bias.
py::tuple python_estimate(const KnownLuminance& known) {
  const bool has_noise = std::isfinite(known.deviation);
  return py::make_tuple(known.mean, has_noise ? known.deviation : 0.0, known.bias,
                        has_noise ? known.freedom : 0.0, known.bias_deviation);
}

/// Low and high ends, [row][column].
py::tuple intervals(const KeptFilm& film, double confidence) {
  const Film& sums = film.checkpoint->film;
  const std::vector<size_t> extents = {size_t(sums.height()), size_t(sums.width())};
  std::vector<double> low(sums.pixel_count()), high(low.size());
  {
    const py::gil_scoped_release released;
    for (size_t i = 0; i < low.size(); ++i) {
      const ConfidenceInterval interval = film.errors().luminance(i, confidence);
      low[i] = interval.mean - interval.half_width;
      high[i] = interval.mean + interval.half_width;
    }
  }
  return py::make_tuple(Buffer{Array::of<double>(extents, std::move(low))},
                        Buffer{Array::of<double>(extents, std::move(high))});
}

std::vector<std::pair<uint32_t, uint32_t>> pass_ranges(const KeptFilm& film) {
  std::vector<std::pair<uint32_t, uint32_t>> ranges;
  for (const PassRange& range : film.checkpoint->film.passes().ranges())
    ranges.emplace_back(range.begin, range.end);
  return ranges;
}

std::vector<std::array<int, 5>> region_rows(const KeptFilm& film) {
  std::vector<std::array<int, 5>> rows;
  for (const FilmRegion& region : film.checkpoint->film.regions())
    rows.push_back({region.pixels.x, region.pixels.y, region.pixels.width, region.pixels.height,
                    int(region.film.pass_count())});
  return rows;
}

}  // namespace

const FilmErrors& KeptFilm::errors() const {
  std::call_once(errors_->once, [this] { errors_->errors.emplace(checkpoint->film); });
  return *errors_->errors;
}

std::vector<uint8_t> KeptFilm::sums() const {
  // All that the passes are a function of, and their sums; not how long they took.
  RenderRecord record = checkpoint->record;
  record.seconds = 0;
  record.plan = {};
  record.recipe.scene.clear();
  record.recipe.folder.clear();
  record.recipe.definitions.clear();
  record.recipe.integrator.clear();
  record.recipe.settings.clear();
  record.outputs = {};
  return checkpoint_bytes(record, checkpoint->film, {});
}

void bind_films(py::module_& module) {
  const auto film_of = [](const KeptFilm& f) -> const Film& { return f.checkpoint->film; };
  py::class_<KeptFilm>(module, "Film")
      .def_static("read", &read_film)
      .def("write", &write_film)
      .def("image", &image)
      .def("__add__", &sum)
      .def("equals", &equal)
      .def_property_readonly("passes", &pass_ranges)
      .def_property_readonly("regions", &region_rows)
      .def_property_readonly("width", [=](const KeptFilm& f) { return film_of(f).width(); })
      .def_property_readonly("height", [=](const KeptFilm& f) { return film_of(f).height(); })
      .def_property_readonly("samples_per_pixel",
                             [=](const KeptFilm& f) { return film_of(f).samples_per_pixel(); })
      .def_property_readonly("seed",
                             [](const KeptFilm& f) { return f.checkpoint->record.recipe.seed; })
      .def_property_readonly("integrator",
                             [](const KeptFilm& f) { return f.checkpoint->record.view.integrator; })
      .def_property_readonly("scene",
                             [](const KeptFilm& f) { return f.checkpoint->record.recipe.scene; })
      .def_property_readonly(
          "definitions", [](const KeptFilm& f) { return f.checkpoint->record.recipe.definitions; })
      .def_property_readonly("settings",
                             [](const KeptFilm& f) {
                               std::vector<std::pair<std::string, std::string>> settings;
                               for (const Setting& s : f.checkpoint->record.recipe.settings)
                                 settings.emplace_back(s.object + "." + s.parameter, s.value);
                               return settings;
                             })
      .def_property_readonly(
          "asked_integrator",
          [](const KeptFilm& f) { return f.checkpoint->record.recipe.integrator; })
      .def_property_readonly(
          "samples_per_pass",
          [](const KeptFilm& f) { return f.checkpoint->record.recipe.samples_per_pass; })
      .def_property_readonly("first_pass",
                             [](const KeptFilm& f) { return f.checkpoint->record.plan.first_pass; })
      .def_property_readonly("is_irradiance",
                             [](const KeptFilm& f) {
                               return f.checkpoint->record.view.quantity == Quantity::irradiance;
                             })
      .def("error",
           [](const KeptFilm& f) {
             const py::gil_scoped_release released;
             return f.errors().of_picture();
           })
      .def("mean_error",
           [](const KeptFilm& f) {
             const py::gil_scoped_release released;
             return f.errors().of_mean();
           })
      .def("pixel",
           [=](const KeptFilm& f, int x, int y) {
             KnownLuminance known;
             {
               const py::gil_scoped_release released;
               known = f.errors().known(size_t(y) * size_t(film_of(f).width()) + size_t(x));
             }
             return python_estimate(known);
           })
      .def("mean",
           [](const KeptFilm& f, int x, int y, int width, int height) {
             KnownLuminance known;
             {
               const py::gil_scoped_release released;
               known = f.errors().known(PixelRegion{x, y, width, height});
             }
             return python_estimate(known);
           })
      .def("intervals", &intervals)
      .def(py::pickle([](const KeptFilm& f) { return py::make_tuple(bytes_of(f)); },
                      [](const py::tuple& s) { return parsed_film(s[0].cast<py::bytes>()); }));
  module.def("half_width", [](double standard_error, double bias, double freedom, double bias_error,
                              double confidence) {
    const double deviation = freedom > 0 ? standard_error : std::numeric_limits<double>::infinity();
    return KnownLuminance{0, deviation, bias, std::max(1.0, freedom), bias_error}
        .interval(confidence)
        .half_width;
  });
}

}  // namespace kaustik::python
