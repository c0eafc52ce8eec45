// The method step by step, with pictures: docs/thesis/walkthrough.md.
#include <fmt/format.h>

#include "hemisphere_drawing.h"
#include "kaustik/photon/light_pass.h"
#include "kaustik/photonmap/photon_light.h"
#include "kaustik/render/photon_tracing.h"
#include "photon_picture.h"
#include "scene_run.h"

namespace kaustik::thesis {
namespace {

constexpr int size = 400;
constexpr const char* scene_name = "cornell_spheres";
/// Fewer photons than usual, or the dots would cover everything.
constexpr const char* few_global = "integrator.global_photons=20000";
constexpr const char* few_caustic = "integrator.caustic_photons=20000";
/// Stops.
constexpr float exposure = 0.7f;

Vec3f color_of(const Spectrum& flux) {
  const float largest = std::max(flux.max_lane(), 1e-30f);
  return {flux[0] / largest, flux[1] / largest, flux[2] / largest};
}

Image picture_of(const SceneRun& run, const Image& first_hits, const PhotonMap& map) {
  PhotonPicture picture(run.scene(), first_hits);
  for (uint32_t i = 0; i < map.size(); ++i)
    picture.add(map.tree().key(i), color_of(map.tree().data(i).flux.spectrum()));
  return picture.image();
}

/// Where photons arrive that come straight from the lights; no map keeps them.
Image picture_of_direct(const SceneRun& run, const Image& first_hits, uint32_t count) {
  PhotonPicture picture(run.scene(), first_hits);
  const EmissionSampler emission(run.scene());
  const auto emit = [&](uint32_t i) -> std::optional<LightPath> {
    Sampler sampler = Sampler::at(1, 0, Stream::photon_global, 0, i);
    const Vec2f u_position = sampler.next_2d(), u_direction = sampler.next_2d();
    const EmittedRay ray = emission.sample(0, u_position, u_direction, sampler.next_1d(), {});
    if (ray.flux.is_zero()) return std::nullopt;
    return LightPath(ray.ray, ray.flux, nullptr, Lobes::specular, sampler, {});
  };
  trace_light_paths(run.scene(), 0, count, {}, emit, [&](const LightVertex& at) {
    picture.add(at.vertex.position(), color_of(at.state.throughput));
    return Lobes::none;
  });
  return picture.image();
}

/// The surface behind a pixel.
std::optional<SurfaceVertex> vertex_behind(const Scene& scene, const Vec2f& raster) {
  const Ray ray = scene.camera().sample_ray(raster, Camera::middle_of_lens());
  Hit hit;
  if (!scene.intersect(ray, hit)) return std::nullopt;
  return SurfaceVertex(scene, ray, hit, TransportMode::radiance);
}

/// Radiance estimates right at the surfaces that the camera sees.
Image picture_of_estimates(const SceneRun& run, const PhotonMap& map,
                           const EstimateSettings& settings) {
  Image image(size, size, {"R", "G", "B"});
  Scratch scratch;
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const auto vertex = vertex_behind(run.scene(), {float(x) + 0.5f, float(y) + 0.5f});
      if (!vertex) continue;
      const Spectrum radiance = map.radiance(*vertex, Lobes::diffuse, settings, scratch).value;
      for (int c = 0; c < 3; ++c) image.at(x, y, c) = radiance[c];
    }
  return image;
}

std::string importance_grid(const SceneRun& run, const PhotonMap& map, const Vec2f& raster) {
  const SurfaceVertex vertex = vertex_behind(run.scene(), raster).value();
  const HemisphereGrid grid{3, 14};
  const Vec3f normal = vertex.facing_normal();
  const Frame frame(normal);
  std::vector<float> importance(size_t(grid.count()));
  std::vector<Vec3f> directions;
  Scratch scratch;
  map.visit_nearest(vertex.position(), normal, 50, infinity, scratch,
                    [&](const Photon& photon, const Vec3f& position) {
                      const Vec3f local =
                          frame.to_local(photon.incident_direction(position, vertex.position()));
                      if (!(local.z > 0)) return;
                      importance[size_t(grid.cell_of(local))] += photon.flux.spectrum().max_lane();
                      directions.push_back(local);
                    });
  return draw_hemisphere(grid, importance, directions);
}

/// The places where the irradiance cache gathers, as the picture's pixels ask for it.
Image picture_of_records(const SceneRun& run, const Image& first_hits, const PhotonMaps& maps) {
  Problems problems;
  const Arguments arguments(PhotonMapSettings::info(), {}, {}, problems);
  const PhotonMapSettings settings(arguments);
  const GatherRadii radii;
  const IrradianceMap precomputed = precomputed_irradiance(run.scene(), settings, maps, radii);
  const ShadowSettings shadows;
  const PhotonLight light(run.scene(), settings, maps, radii, precomputed, nullptr, shadows,
                          Pass{});
  IrradianceCache cache(settings.cache_settings);
  uint32_t round = 0;
  for (const int stride : {8, 4, 2, 1}) {
    std::vector<CachePoint> points;
    for (int y = 0; y < size; y += stride)
      for (int x = 0; x < size; x += stride) {
        const auto vertex = vertex_behind(run.scene(), {float(x) + 0.5f, float(y) + 0.5f});
        if (!vertex || !any(vertex->lobes() & Lobes::diffuse)) continue;
        CachePoint point{vertex->point(), vertex->facing_normal()};
        point.pixel_width = 2 * run.scene().camera().traits().pixel_spread *
                            length(vertex->position() - run.scene().camera().traits().position);
        points.push_back(point);
      }
    cache.fill_round(points, light, Sampler::at(1, 0, Stream::cache, 0, 0), round++, {});
  }
  PhotonPicture picture(run.scene(), first_hits);
  for (const CacheRecord& record : cache.records())
    picture.add(record.position, color_of(record.irradiance));
  return picture.image();
}

struct Section {
  const char* text;
  std::vector<std::string> pictures;
};

std::string page_of(const std::vector<Section>& sections) {
  std::string page =
      "# Photon mapping step by step\n\n"
      "The method of Schregle's thesis, on a Cornell box with a mirror sphere and a glass sphere "
      "(`scenes/cornell_spheres`).\n`make thesis` makes these pictures.\n";
  for (const Section& section : sections) {
    page += fmt::format("\n{}\n\n", section.text);
    for (const std::string& picture : section.pictures) page += picture + "\n";
  }
  return page;
}

}  // namespace

std::string walkthrough(const Workplace& place) {
  const SceneRun run(scene_name, {"photonmap", {}, size, size});
  const Image whole =
      run.render(in_passes(uint32_t(place.scaled(256)), 16, 1, place.threads)).image;
  const SceneRun few(scene_name, {"photonmap", {few_global, few_caustic}, size, size});
  const PhotonMaps maps =
      trace_photon_maps(few.description(), few.scene(), 1, place.threads).photons.maps;
  const PhotonMaps all =
      trace_photon_maps(run.description(), run.scene(), 1, place.threads).photons.maps;
  const auto show = [&](const Image& image, const char* name, const char* alt,
                        const char* layer = "", float stops = exposure) {
    return place.show(image, std::string("walkthrough_") + name, alt, stops, layer);
  };
  const Vec2f grid_raster(0.5f * size, 0.85f * size);
  place.write_text(place.docs / "pictures/walkthrough_grid.svg",
                   importance_grid(run, all.global, grid_raster));
  EstimateSettings estimate;
  const std::vector<Section> sections{
      {"## The light pass\n\nLamps send out photons, each with its share of the lamp's power. "
       "Where "
       "they arrive first is direct light; no map keeps it,\nshadow rays find it with less noise.",
       {show(picture_of_direct(few, whole, 20000), "direct_photons",
             "photons that come straight from the lamp")}},
      {"From a specular surface (mirror, glass) photons go on until they meet a diffuse one. There "
       "they are stored as *caustic* photons:\nunder the glass sphere they gather in a spot. They "
       "are aimed at the two spheres, so that few are lost.",
       {show(picture_of(few, whole, maps.caustic), "caustic_photons", "caustic photons")}},
      {"After a diffuse surface they are *global* photons: indirect light, red beside the red "
       "wall, "
       "green beside the green one.\nRussian roulette decides who goes on, so all carry about the "
       "same power.",
       {show(picture_of(few, whole, maps.global), "global_photons", "global photons")}},
      {"## The radiance estimate\n\nThe power of the nearest photons over the area of the disk "
       "that "
       "holds them is irradiance. Seen directly, the global map is\nblotchy (50 photons of 200 000 "
       "emitted): it serves where gather rays end, never where the camera looks.",
       {show(picture_of_estimates(run, all.global, estimate), "global_estimate",
             "the global map, seen directly")}},
      {"Caustic photons lie dense where the light is focused, so there the map is good enough to "
       "be "
       "seen. A cone filter keeps the edges sharp.",
       {show(whole, "caustic", "caustics", "caustic", exposure)}},
      {"## Gather rays\n\nDiffuse indirect light at a visible point is gathered by rays over its "
       "hemisphere. They go where the light comes from: the\nphotons around the point are sorted "
       "by "
       "their direction into a grid of 3 × 14 cells of equal projected solid angle, and\ncells are "
       "drawn in proportion to the flux that they hold (dots: the photons; this is the point at "
       "the "
       "middle of the floor's front).\nA part of the rays goes to all cells alike, so that no "
       "light "
       "is forgotten.",
       {"![importance grid](pictures/walkthrough_grid.svg)"}},
      {"The irradiance cache gathers only where it must: densely where indirect light changes "
       "fast, in corners and near things, and sparsely\nwhere it is even. Between its records "
       "(dots) "
       "it interpolates.",
       {show(picture_of_records(run, whole, all), "cache_records", "records of the cache")}},
      {"## The parts of the picture\n\nEvery path of light has one owner. *Direct* light by shadow "
       "rays:",
       {show(whole, "component_direct", "direct light", "direct")}},
      {"*Caustics* by the caustic map are above. *Indirect* light by gather rays and the "
       "irradiance "
       "cache:",
       {show(whole, "component_indirect", "diffuse indirect light", "indirect")}},
      {"*Specular* light, what the mirror and the glass show, by following the camera's rays:",
       {show(whole, "component_specular", "specular light", "specular")}},
      {"With the lamp itself (*emission*) they sum to the picture:",
       {show(whole, "sum", "all of it")}},
  };
  place.write_text(place.docs / "walkthrough.md", page_of(sections));
  return "The method with pictures of its photons, its sampling grid and its parts is a [page of "
         "its own](walkthrough.md).\n";
}

}  // namespace kaustik::thesis
