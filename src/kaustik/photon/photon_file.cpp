// The content of a .kpm file, in the frame of base/binary_file.h:
//   scene (u64 length, bytes), fingerprint: counts (u64 length, bytes), numbers (u64), 16 sums (f64
//   each); seed (u64), wavelengths (4 × f32, nm; zeros: red, green and blue),
//   settings: global_photons, caustic_photons (u32), maximum_events (i32), traced, reradiate, aim
//   (u8 each), target_budget (i32),
//   part index and count (u32 each),
//   twice (global, caustic): report: rays, target_count, number of lights (u64), per light the
//   seven counts (six u64, one f64); number of photons (u64), mean flux (f32);
//   twice (global, caustic), each at a multiple of 64 bytes from the file's begin: the arrays of
//   the tree, as they are in memory: buckets (192 bytes each, of 16 positions), nodes of all levels
//   from the lowest on (192 bytes, the boxes of 8 children), photons (32 bytes), sides (50 bytes of
//   16 photons). How long they are follows from the number of photons.
#include "kaustik/photon/photon_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kaustik/base/binary_file.h"
#include "kaustik/base/bytes.h"
#include "kaustik/base/parallel.h"

namespace kaustik {
namespace {

constexpr BinaryFileKind photon_map_kind = {
    {0x89, 'K', 'P', 'M', '\r', '\n', 0x1a, '\n'},
    8,  // the layouts of Photon and its tree are part of the file's
    "photon map",
    "give a .kpm file, of photons that Kaustik has traced in a scene",
    "trace them again with this version of Kaustik"};
constexpr size_t bytes_per_photon = sizeof(Vec3f) + sizeof(Photon);
constexpr size_t bytes_per_light = 7 * sizeof(uint64_t);
static_assert(std::is_trivially_copyable_v<Photon> && sizeof(Vec3f) == 12);
static_assert(sizeof(Photon) == 32 && sizeof(KdBuckets::Bucket) == 192 &&
              sizeof(KdBuckets::Node) == 192 && sizeof(PhotonSides::Block) == 50);

/// In the order in which they lie in the file.
constexpr std::array tree_parts{TreePart::buckets, TreePart::nodes, TreePart::photons,
                                TreePart::sides};
/// At whose multiples arrays begin.
constexpr uint64_t array_alignment = 64;
uint64_t aligned(uint64_t place) {
  return (place + array_alignment - 1) / array_alignment * array_alignment;
}

/// Where a part of a map of so many photons lies that begins there.
uint64_t begin_of(TreePart part, uint64_t map_begin, size_t count) {
  uint64_t begin = aligned(map_begin);
  for (const TreePart before : tree_parts) {
    if (before == part) break;
    begin = aligned(begin + item_count(before, count) * item_bytes(before));
  }
  return begin;
}
uint64_t end_of(uint64_t map_begin, size_t count) {
  constexpr TreePart last = tree_parts.back();
  return begin_of(last, map_begin, count) + item_count(last, count) * item_bytes(last);
}

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

void put_report(BinaryWriter& writer, const MapReport& report) {
  writer.put(report.rays);
  writer.put(uint64_t(report.target_count));
  writer.put(uint64_t(report.lights.size()));
  for (const LightCounts& c : report.lights) {
    for (const uint64_t count :
         {c.emitted, c.stored, c.nothing, c.escaped, c.absorbed, c.too_long, c.stopped})
      writer.put(count);
    writer.put(c.stored_flux);
  }
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

bool is_valid(const Vec3f& position, const Photon& photon) {
  const auto is_flux = [](float lane) { return std::isfinite(lane) && lane >= 0; };
  return max_abs(position) < KdBuckets::max_coordinate && is_finite(position) &&
         photon.distance >= 0 && photon.on_front <= 1 &&
         std::ranges::all_of(photon.flux.lanes, is_flux);
}

void check_photons(const BinaryReader& reader, const KdBuckets& buckets,
                   std::span<const Photon> photons) {
  constexpr size_t block_size = size_t{1} << 16;
  std::vector<size_t> wrong((photons.size() + block_size - 1) / block_size, photons.size());
  parallel_blocks(photons.size(), block_size, [&](size_t begin, size_t end, size_t block) {
    for (size_t i = begin; i < end && wrong[block] == photons.size(); ++i)
      if (!is_valid(buckets.position(uint32_t(i)), photons[i])) wrong[block] = i;
  });
  for (const size_t i : wrong)
    if (i < photons.size()) reader.damaged(fmt::format("photon {} is not valid", i));
  // Searches must not find what is not there.
  for (size_t i = photons.size(); i < buckets.bucket_count() * KdBuckets::bucket_size; ++i)
    if (!buckets.removed(uint32_t(i))) reader.damaged("there is something behind its last photon");
}

MapReport get_report(BinaryReader& reader) {
  MapReport report;
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
  return report;
}

/// What the head tells of a map.
struct MapHead {
  explicit MapHead(BinaryReader& reader)
      : report(get_report(reader)),
        count(size_t(reader.get_count(bytes_per_photon))),
        mean_flux(reader.get<float>()) {
    if (count > KdTree<3, Vec3f, Photon>::max_size) reader.damaged("it holds too many photons");
    if (!std::isfinite(mean_flux) || mean_flux < 0) reader.damaged("a mean flux is not valid");
  }
  MapReport report;
  size_t count;
  float mean_flux;
};

using MappedBytes = std::shared_ptr<const std::span<const uint8_t>>;

/// Goes on behind the map.
PhotonMap get_map(BinaryReader& reader, const MapHead& head, const MappedBytes& file) {
  const uint64_t begin = reader.position();
  reader.skip_to(end_of(begin, head.count));
  const auto items = [&]<typename Item>(TreePart part, const Item*) {
    const uint8_t* const first = file->data() + begin_of(part, begin, head.count);
    return KeptArray<Item>({reinterpret_cast<const Item*>(first), item_count(part, head.count)},
                           file);
  };
  KdBuckets buckets = KdBuckets::of(
      head.count, items(TreePart::buckets, static_cast<const KdBuckets::Bucket*>(nullptr)),
      items(TreePart::nodes, static_cast<const KdBuckets::Node*>(nullptr)));
  KeptArray<Photon> photons = items(TreePart::photons, static_cast<const Photon*>(nullptr));
  check_photons(reader, buckets, photons.all());
  return {SidedTree<Photon>(
              {std::move(buckets), std::move(photons)},
              PhotonSides(items(TreePart::sides, static_cast<const PhotonSides::Block*>(nullptr)))),
          head.mean_flux};
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

void put_map(PhotonFileWriter& writer, size_t index, const PhotonMap& map) {
  const KdBuckets& buckets = map.tree().buckets();
  writer.put(index, TreePart::buckets, 0, bytes_in(buckets.buckets()));
  writer.put(index, TreePart::nodes, 0, bytes_in(buckets.nodes()));
  writer.put(index, TreePart::photons, 0, bytes_in(map.tree().data()));
  writer.put(index, TreePart::sides, 0, bytes_in(map.sides().blocks()));
  writer.set_mean_flux(index, map.mean_flux());
}

}  // namespace

PhotonFileWriter::PhotonFileWriter(const std::string& path, const StoredPhotons& photons,
                                   const std::array<size_t, 2>& counts)
    : file_(path), photons_(photons), counts_(counts) {
  begins_[0] = head().size();
  begins_[1] = end_of(begins_[0], counts_[0]);
  // As long as it will be: what lies between arrays are zeros.
  file_.write(end_of(begins_[1], counts_[1]) - 1, std::array<uint8_t, 1>{});
}

std::vector<uint8_t> PhotonFileWriter::head() const {
  BinaryWriter writer(photon_map_kind);
  writer.put_text(photons_.scene);
  put_fingerprint(writer, photons_.fingerprint);
  writer.put(photons_.seed);
  put_wavelengths(writer, photons_.wavelengths);
  put_settings(writer, photons_.settings);
  const std::array reports{&photons_.maps.global_report, &photons_.maps.caustic_report};
  for (size_t i = 0; i < reports.size(); ++i) {
    put_report(writer, *reports[i]);
    writer.put(uint64_t(counts_[i]));
    writer.put(mean_fluxes_[i]);
  }
  return {writer.bytes().begin(), writer.bytes().end()};
}

void PhotonFileWriter::put(size_t map, TreePart part, uint64_t first,
                           std::span<const uint8_t> items) {
  file_.write(begin_of(part, begins_[map], counts_[map]) + first * item_bytes(part), items);
}

void PhotonFileWriter::finish() {
  file_.write(0, head());
  add_checksum(file_, end_of(begins_[1], counts_[1]));
  file_.finish();
}

void write_photon_file(const std::string& path, const StoredPhotons& photons) {
  const PhotonMaps& maps = photons.maps;
  PhotonFileWriter writer(path, photons, {maps.global.size(), maps.caustic.size()});
  put_map(writer, 0, maps.global);
  put_map(writer, 1, maps.caustic);
  writer.finish();
}

StoredPhotons read_photon_file(const std::string& path) {
  BinaryReader reader(photon_map_kind, path);
  StoredPhotons photons;
  photons.scene = reader.get_text();
  photons.fingerprint = get_fingerprint(reader);
  photons.seed = reader.get<uint64_t>();
  photons.wavelengths = get_wavelengths(reader);
  photons.settings = get_settings(reader);
  const MapHead global(reader), caustic(reader);
  if (global.report.lights.size() != caustic.report.lights.size())
    reader.damaged("its maps differ in the number of lights");
  const MappedBytes file = reader.mapped();
  photons.maps.global = get_map(reader, global, file);
  photons.maps.caustic = get_map(reader, caustic, file);
  photons.maps.global_report = global.report;
  photons.maps.caustic_report = caustic.report;
  reader.expect_end();
  return photons;
}

bool is_photon_file(const std::string& path) { return is_of_kind(photon_map_kind, path); }

}  // namespace kaustik
