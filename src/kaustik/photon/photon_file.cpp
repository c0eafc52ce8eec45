// The content of a .kpm file, in the frame of base/binary_file.h:
//   scene (u64 length, bytes), fingerprint: counts (u64 length, bytes), numbers (u64), 16 sums (f64
//   each); seed (u64), wavelengths (4 × f32, nm; zeros: red, green and blue),
//   settings: global_photons, caustic_photons (u32), maximum_events (i32), traced, reradiate, aim
//   (u8 each), target_budget (i32),
//   part index and count (u32 each),
//   twice (global, caustic): report: rays, target_count, number of lights (u64), per light the
//   seven counts (six u64, one f64); number of photons n (u64), n × position (3 × f32),
//   n × Photon (32 bytes).
#include "kaustik/photon/photon_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kaustik/base/binary_file.h"
#include "kaustik/base/checksum.h"

namespace kaustik {
namespace {

constexpr BinaryFileKind photon_map_kind = {
    {0x89, 'K', 'P', 'M', '\r', '\n', 0x1a, '\n'},
    6,  // Photon's layout is part of the file's
    "photon map",
    "give a .kpm file, of photons that Kaustik has traced in a scene",
    "trace them again with this version of Kaustik"};
constexpr size_t bytes_per_photon = sizeof(Vec3f) + sizeof(Photon);
constexpr size_t bytes_per_light = 7 * sizeof(uint64_t);
static_assert(std::is_trivially_copyable_v<Photon> && sizeof(Vec3f) == 12);

void put_wavelengths(BinaryWriter& writer, const Wavelengths& wavelengths) {
  for (int lane = 0; lane < Spectrum::lane_count; ++lane)
    writer.put(wavelengths.is_rgb() ? 0.0f : wavelengths[lane]);
}

Wavelengths get_wavelengths(BinaryReader& reader) {
  std::array<float, Spectrum::lane_count> nm{};
  for (float& of_lane : nm) of_lane = reader.get<float>();
  const auto all = [&](const auto& is_so) { return std::all_of(nm.begin(), nm.end(), is_so); };
  if (all([](float of_lane) { return of_lane == 0; })) return {};
  if (!all([](float of_lane) { return std::isfinite(of_lane) && of_lane > 0; }))
    reader.damaged("its wavelengths are not valid");
  return {nm[0], nm[1], nm[2], nm[3]};
}

void put_settings(BinaryWriter& writer, const LightPassSettings& s) {
  writer.put(s.global_photons);
  writer.put(s.caustic_photons);
  writer.put(int32_t(s.maximum_events));
  writer.put(uint8_t(s.traced));
  writer.put(uint8_t(s.reradiate));
  writer.put(uint8_t(s.aim));
  writer.put(int32_t(s.target_budget));
  writer.put(s.part.index);
  writer.put(s.part.count);
}

void put_map(BinaryWriter& writer, const PhotonMap& map, const MapReport& report) {
  writer.put(report.rays);
  writer.put(uint64_t(report.target_count));
  writer.put(uint64_t(report.lights.size()));
  for (const LightCounts& c : report.lights) {
    for (const uint64_t count :
         {c.emitted, c.stored, c.nothing, c.escaped, c.absorbed, c.too_long, c.stopped})
      writer.put(count);
    writer.put(c.stored_flux);
  }
  writer.put(uint64_t(map.size()));
  writer.reserve(map.size() * bytes_per_photon);
  for (uint32_t i = 0; i < map.size(); ++i) {
    const Vec3f position = map.tree().key(i);
    writer.put_bytes(&position, sizeof position);
  }
  writer.put_bytes(map.tree().data().data(), map.tree().data().size_bytes());
}

LightPassSettings get_settings(BinaryReader& reader) {
  LightPassSettings s;
  s.global_photons = reader.get<uint32_t>();
  s.caustic_photons = reader.get<uint32_t>();
  s.maximum_events = reader.get<int32_t>();
  const auto traced = reader.get<uint8_t>();
  if (traced > uint8_t(Lobes::all)) reader.damaged("a setting in it is not valid");
  s.traced = Lobes(traced);
  s.reradiate = reader.get_flag();
  const auto aim = reader.get<uint8_t>();
  if (aim > uint8_t(Aim::projection_map)) reader.damaged("a setting in it is not valid");
  s.aim = Aim(aim);
  s.target_budget = reader.get<int32_t>();
  s.part.index = reader.get<uint32_t>();
  s.part.count = reader.get<uint32_t>();
  if (s.part.index >= s.part.count || s.part.count > PhotonPart::maximum_count)
    reader.damaged("a setting in it is not valid");
  return s;
}

void check_photons(const BinaryReader& reader, const std::vector<Vec3f>& positions,
                   const std::vector<Photon>& photons) {
  for (size_t i = 0; i < photons.size(); ++i) {
    const Photon& photon = photons[i];
    bool valid = max_abs(positions[i]) < KdBuckets::max_coordinate && is_finite(positions[i]) &&
                 photon.distance >= 0 && photon.on_front <= 1;
    for (const float lane : photon.flux.lanes) valid = valid && std::isfinite(lane) && lane >= 0;
    if (!valid) reader.damaged(fmt::format("photon {} is not valid", i));
  }
}

PhotonMap get_map(BinaryReader& reader, MapReport& report) {
  report.rays = reader.get<uint64_t>();
  report.target_count = size_t(reader.get<uint64_t>());
  report.lights.resize(reader.get_count(bytes_per_light));
  for (LightCounts& c : report.lights) {
    for (uint64_t* count :
         {&c.emitted, &c.stored, &c.nothing, &c.escaped, &c.absorbed, &c.too_long, &c.stopped})
      *count = reader.get<uint64_t>();
    c.stored_flux = reader.get<double>();
    if (!std::isfinite(c.stored_flux)) reader.damaged("a light's flux is not finite");
  }
  const uint64_t count = reader.get_count(bytes_per_photon);
  if (count > KdTree<3, Vec3f, Photon>::max_size) reader.damaged("it holds too many photons");
  auto positions = reader.get_array<Vec3f>(count);
  auto photons = reader.get_array<Photon>(count);
  check_photons(reader, positions, photons);
  return {std::move(positions), std::move(photons)};
}

void put_fingerprint(BinaryWriter& writer, const SceneFingerprint& fingerprint) {
  writer.put_text(fingerprint.counts);
  writer.put(fingerprint.numbers);
  for (const double sum : fingerprint.sums) writer.put(sum);
}

SceneFingerprint get_fingerprint(BinaryReader& reader) {
  SceneFingerprint fingerprint;
  fingerprint.counts = reader.get_text();
  fingerprint.numbers = reader.get<uint64_t>();
  for (double& sum : fingerprint.sums) sum = reader.get<double>();
  return fingerprint;
}

}  // namespace

void write_photon_file(const std::string& path, const StoredPhotons& photons) {
  BinaryWriter writer(photon_map_kind);
  writer.put_text(photons.scene);
  put_fingerprint(writer, photons.fingerprint);
  writer.put(photons.seed);
  put_wavelengths(writer, photons.wavelengths);
  put_settings(writer, photons.settings);
  put_map(writer, photons.maps.global, photons.maps.global_report);
  put_map(writer, photons.maps.caustic, photons.maps.caustic_report);
  writer.write_to(path);
}

StoredPhotons read_photon_file(const std::string& path) {
  BinaryReader reader(photon_map_kind, path);
  StoredPhotons photons;
  photons.scene = reader.get_text();
  photons.fingerprint = get_fingerprint(reader);
  photons.seed = reader.get<uint64_t>();
  photons.wavelengths = get_wavelengths(reader);
  photons.settings = get_settings(reader);
  photons.maps.global = get_map(reader, photons.maps.global_report);
  photons.maps.caustic = get_map(reader, photons.maps.caustic_report);
  reader.expect_end();
  if (photons.maps.global_report.lights.size() != photons.maps.caustic_report.lights.size())
    reader.damaged("its maps differ in the number of lights");
  return photons;
}

bool is_photon_file(const std::string& path) { return is_of_kind(photon_map_kind, path); }

}  // namespace kaustik
