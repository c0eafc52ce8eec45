// Photon maps: traced, kept in files, and shown as arrays.
#include <algorithm>
#include <memory>

#include "bind.h"
#include "kaustik/base/processors.h"
#include "kaustik/base/version.h"
#include "kaustik/base/wavelengths.h"
#include "kaustik/render/job.h"
#include "kaustik/render/photon_tracing.h"

namespace kaustik::python {
namespace {

/// Immutable; Python's `Photons`.
struct KeptPhotons {
  std::shared_ptr<const StoredPhotons> stored;

  const PhotonMap& map(const std::string& kind) const {
    if (kind == "global") return stored->maps.global;
    if (kind == "caustic") return stored->maps.caustic;
    throw py::key_error(kind);
  }
};

/// [photon][component] of what `values` makes of a photon and its position.
template <typename Values>
Buffer rows_of_photons(const KeptPhotons& photons, const std::string& kind, const Values& values) {
  const auto& tree = photons.map(kind).tree();
  std::vector<float> rows(3 * tree.size());
  for (size_t i = 0; i < tree.size(); ++i) {
    const Vec3f row = values(tree.data(uint32_t(i)), tree.key(uint32_t(i)));
    for (int axis = 0; axis < 3; ++axis) rows[3 * i + size_t(axis)] = row[axis];
  }
  return {Array::of<float>({tree.size(), 3}, std::move(rows))};
}

Buffer positions(const KeptPhotons& photons, const std::string& kind) {
  return rows_of_photons(photons, kind, [](const Photon&, const Vec3f& at) { return at; });
}

/// The way that the light went.
Buffer directions(const KeptPhotons& photons, const std::string& kind) {
  return rows_of_photons(photons, kind,
                         [](const Photon& p, const Vec3f&) { return -p.direction.unpack(); });
}

Buffer normals(const KeptPhotons& photons, const std::string& kind) {
  return rows_of_photons(photons, kind,
                         [](const Photon& p, const Vec3f&) { return p.side.unpack(); });
}

Buffer powers(const KeptPhotons& photons, const std::string& kind) {
  const Wavelengths& wavelengths = photons.stored->wavelengths;
  return rows_of_photons(photons, kind, [&](const Photon& p, const Vec3f&) {
    const Spectrum rgb = rgb_from_lanes(p.flux.spectrum(), wavelengths);
    return Vec3f(rgb[0], rgb[1], rgb[2]);
  });
}

Buffer paths(const KeptPhotons& photons, const std::string& kind) {
  const auto& tree = photons.map(kind).tree();
  std::vector<uint32_t> numbers(tree.size());
  for (size_t i = 0; i < numbers.size(); ++i) numbers[i] = tree.data(uint32_t(i)).path;
  const size_t count = numbers.size();
  return {Array::of<uint32_t>({count}, std::move(numbers))};
}

/// Indices of lamps; of a part of a pass they are not known.
Buffer lamps(const KeptPhotons& photons, const std::string& kind) {
  std::vector<uint32_t> indices = lamps_of(*photons.stored, photons.map(kind));
  const size_t count = indices.size();
  return {Array::of<uint32_t>({count}, std::move(indices))};
}

/// Of all lamps together.
py::dict light_counts(const KeptPhotons& photons, const std::string& kind) {
  const PhotonMaps& maps = photons.stored->maps;
  photons.map(kind);
  const LightCounts all = (kind == "global" ? maps.global_report : maps.caustic_report).total();
  py::dict counts;
  counts["emitted"] = all.emitted;
  counts["stored"] = all.stored;
  counts["nothing"] = all.nothing;
  counts["escaped"] = all.escaped;
  counts["absorbed"] = all.absorbed;
  counts["too_long"] = all.too_long;
  counts["stopped"] = all.stopped;
  counts["stored_flux"] = all.stored_flux;
  return counts;
}

KeptPhotons read_photons(const std::string& path) {
  const py::gil_scoped_release released;
  return {std::make_shared<const StoredPhotons>(read_photon_file(path))};
}

void write_photons(const KeptPhotons& photons, const std::string& path) {
  const py::gil_scoped_release released;
  write_photon_file(path, *photons.stored);
}

KeptPhotons merged(const std::vector<KeptPhotons>& parts) {
  const py::gil_scoped_release released;
  std::vector<StoredPhotons> all;
  for (const KeptPhotons& part : parts) all.push_back(*part.stored);
  return {std::make_shared<const StoredPhotons>(merged_photons(all))};
}

/// Traces in the thread that calls run(); another one may stop it.
class PhotonTracing {
 public:
  PhotonTracing(const DescribedScene& scene, uint64_t seed, int threads, uint32_t part_index,
                uint32_t part_count, std::string name)
      : part_{part_index, part_count}, name_(std::move(name)) {
    JobSettings settings;
    settings.task = JobTask::trace_photons;
    settings.record.program = KAUSTIK_VERSION;
    settings.record.recipe.integrator = "photonmap";
    settings.record.recipe.seed = seed;
    settings.record.recipe.is_strict = scene.description->is_strict;
    settings.session.seed = seed;
    settings.session.threads = std::min(threads, usable_processors());
    settings.previous = scene.built;
    Description description = copy_of(*scene.description);
    add_camera_if_missing(description);
    job_ = std::make_unique<Job>(std::move(description), std::move(settings), JobListener{});
  }

  void cancel() { job_->cancel(); }
  /// The photons, what is odd about them, and the names of the lamps.
  py::tuple run() {
    TracedPhotons traced;
    {
      const py::gil_scoped_release released;
      traced = job_->trace_photons(part_);
      traced.photons.scene = name_;
    }
    const Scene& scene = job_->scene();
    std::vector<std::string> names;
    for (size_t i = 0; i < scene.lights().size(); ++i) names.push_back(scene.light_name(i));
    return py::make_tuple(
        KeptPhotons{std::make_shared<const StoredPhotons>(std::move(traced.photons))},
        traced.warnings, names);
  }

 private:
  PhotonPart part_;
  std::string name_;
  std::unique_ptr<Job> job_;
};

}  // namespace

void bind_photons(py::module_& module) {
  py::class_<KeptPhotons>(module, "Photons")
      .def_static("read", &read_photons)
      .def_static("merged", &merged)
      .def("write", &write_photons)
      .def("count",
           [](const KeptPhotons& p, const std::string& kind) { return p.map(kind).size(); })
      .def("positions", &positions)
      .def("directions", &directions)
      .def("normals", &normals)
      .def("powers", &powers)
      .def("paths", &paths)
      .def("lamps", &lamps)
      .def("light_counts", &light_counts)
      .def_property_readonly("scene", [](const KeptPhotons& p) { return p.stored->scene; })
      .def_property_readonly("seed", [](const KeptPhotons& p) { return p.stored->seed; })
      .def_property_readonly(
          "is_whole", [](const KeptPhotons& p) { return p.stored->settings.part.is_whole(); });
  py::class_<PhotonTracing>(module, "PhotonTracing")
      .def(py::init<const DescribedScene&, uint64_t, int, uint32_t, uint32_t, std::string>())
      .def("run", &PhotonTracing::run)
      .def("cancel", &PhotonTracing::cancel);
  module.attr("most_photon_parts") = uint32_t(PhotonPart::maximum_count);
}

}  // namespace kaustik::python
