// The layout of a .kpm file, in the byte order of the machine that wrote it:
//   magic (8 bytes), byte order mark (u32), version (u32),
//   scene and fingerprint (each: u64 length, bytes), seed (u64),
//   settings: global_photons, caustic_photons (u32), maximum_events (i32), traced, reradiate, aim
//   (u8 each), target_budget (i32),
//   part index and count (u32 each),
//   twice (global, caustic): report: rays, target_count, number of lights (u64), per light the
//   seven counts (six u64, one f64); number of photons n (u64), n × position (3 × f32),
//   n × Photon (28 bytes),
//   checksum of all that precedes (u64).
#include "kaustik/photon/photon_file.h"

#include <fmt/format.h>

#include <cstring>
#include <span>

#include "kaustik/base/file.h"

namespace kaustik {
namespace {

// A byte over 127 and both kinds of line ends show damage by transfers as text.
constexpr std::array<uint8_t, 8> magic = {0x89, 'K', 'P', 'M', '\r', '\n', 0x1a, '\n'};
constexpr uint32_t byte_order_mark = 0x01020304, swapped_byte_order_mark = 0x04030201;
constexpr uint32_t version = 3;  // to be raised whenever the layout changes, Photon's included
constexpr size_t checksum_size = sizeof(uint64_t);
constexpr size_t bytes_per_photon = sizeof(Vec3f) + sizeof(Photon);
constexpr size_t bytes_per_light = 7 * sizeof(uint64_t);
static_assert(std::is_trivially_copyable_v<Photon> && sizeof(Vec3f) == 12);

/// Changes with every byte: each step is a bijection of both its arguments.
uint64_t checksum(std::span<const uint8_t> bytes) {
  uint64_t sum = bytes.size();
  for (; bytes.size() >= 8; bytes = bytes.subspan(8)) {
    uint64_t word;
    std::memcpy(&word, bytes.data(), 8);
    sum = (sum ^ word) * 0x9e3779b97f4a7c15ull;
    sum ^= sum >> 32;
  }
  for (const uint8_t byte : bytes) sum = (sum ^ byte) * 0x9e3779b97f4a7c15ull;
  return sum ^ (sum >> 32);
}

class Writer {
 public:
  template <typename T>
  void put(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    put_bytes(&value, sizeof(T));
  }
  void put_bytes(const void* data, size_t size) {
    const auto* bytes = static_cast<const uint8_t*>(data);
    bytes_.insert(bytes_.end(), bytes, bytes + size);
  }
  void put_text(const std::string& text) {
    put(uint64_t(text.size()));
    put_bytes(text.data(), text.size());
  }
  void put_settings(const LightPassSettings& s) {
    put(s.global_photons);
    put(s.caustic_photons);
    put(int32_t(s.maximum_events));
    put(uint8_t(s.traced));
    put(uint8_t(s.reradiate));
    put(uint8_t(s.aim));
    put(int32_t(s.target_budget));
    put(s.part.index);
    put(s.part.count);
  }
  void put_map(const PhotonMap& map, const MapReport& report) {
    put(report.rays);
    put(uint64_t(report.target_count));
    put(uint64_t(report.lights.size()));
    for (const LightCounts& c : report.lights) {
      for (const uint64_t count :
           {c.emitted, c.stored, c.nothing, c.escaped, c.absorbed, c.too_long, c.stopped})
        put(count);
      put(c.stored_flux);
    }
    put(uint64_t(map.size()));
    bytes_.reserve(bytes_.size() + map.size() * bytes_per_photon + checksum_size);
    for (uint32_t i = 0; i < map.size(); ++i) {
      const Vec3f position = map.tree().key(i);
      put_bytes(&position, sizeof position);
    }
    put_bytes(map.tree().data().data(), map.tree().data().size_bytes());
  }
  void put_checksum() { put(checksum(bytes_)); }
  const std::vector<uint8_t>& bytes() const { return bytes_; }

 private:
  std::vector<uint8_t> bytes_;
};

class Reader {
 public:
  explicit Reader(const std::string& path) : path_(path), bytes_(read_file(path)), rest_(bytes_) {}

  StoredPhotons read() {
    check_frame();
    StoredPhotons photons;
    photons.scene = get_text();
    photons.fingerprint = get_text();
    photons.seed = get<uint64_t>();
    photons.settings = get_settings();
    photons.maps.global = get_map(photons.maps.global_report);
    photons.maps.caustic = get_map(photons.maps.caustic_report);
    if (!rest_.empty()) damaged("something follows its end");
    if (photons.maps.global_report.lights.size() != photons.maps.caustic_report.lights.size())
      damaged("its maps differ in the number of lights");
    return photons;
  }

 private:
  [[noreturn]] void fail(const std::string& what, const std::string& remedy) const {
    throw Error(ErrorKind::input, what, remedy, place_in(path_));
  }
  [[noreturn]] void damaged(const std::string& why) const {
    fail(fmt::format("the photon map is damaged: {}", why),
         "write it again with: kaustik photons SCENE -o MAP.kpm");
  }

  /// Magic, byte order, version and checksum; what remains is the content.
  void check_frame() {
    if (bytes_.size() < magic.size() || !std::equal(magic.begin(), magic.end(), bytes_.begin()))
      fail("this is not a photon map",
           "give a .kpm file that was written by: kaustik photons SCENE -o MAP.kpm");
    rest_ = rest_.subspan(magic.size());
    const auto order = get<uint32_t>();
    if (order == swapped_byte_order_mark)
      fail("the photon map was written on a machine of the other byte order",
           "write it again on this kind of machine");
    if (order != byte_order_mark) damaged("its header is not valid");
    const auto found_version = get<uint32_t>();
    if (found_version != version)
      fail(fmt::format("the photon map has version {}, this program reads version {}",
                       found_version, version),
           "write it again with this program: kaustik photons SCENE -o MAP.kpm");
    if (rest_.size() < checksum_size) damaged("it is truncated");
    const size_t content = bytes_.size() - checksum_size;
    uint64_t stored;
    std::memcpy(&stored, bytes_.data() + content, checksum_size);
    if (stored != checksum(std::span(bytes_).first(content)))
      damaged("its checksum does not match, it is truncated or bytes have changed");
    rest_ = rest_.first(rest_.size() - checksum_size);
  }

  void need(uint64_t count, size_t item_size) const {
    if (count > rest_.size() / item_size) damaged("a count in it is larger than the file");
  }
  template <typename T>
  T get() {
    need(1, sizeof(T));
    T value;
    std::memcpy(&value, rest_.data(), sizeof(T));
    rest_ = rest_.subspan(sizeof(T));
    return value;
  }
  template <typename T>
  std::vector<T> get_array(uint64_t count) {
    need(count, sizeof(T));
    std::vector<T> values(count);
    if (count > 0) std::memcpy(static_cast<void*>(values.data()), rest_.data(), count * sizeof(T));
    rest_ = rest_.subspan(count * sizeof(T));
    return values;
  }
  std::string get_text() {
    const std::vector<char> text = get_array<char>(get<uint64_t>());
    return {text.begin(), text.end()};
  }
  bool get_flag() {
    const auto value = get<uint8_t>();
    if (value > 1) damaged("a setting in it is not valid");
    return value == 1;
  }

  LightPassSettings get_settings() {
    LightPassSettings s;
    s.global_photons = get<uint32_t>();
    s.caustic_photons = get<uint32_t>();
    s.maximum_events = get<int32_t>();
    const auto traced = get<uint8_t>();
    if (traced > uint8_t(Lobes::all)) damaged("a setting in it is not valid");
    s.traced = Lobes(traced);
    s.reradiate = get_flag();
    const auto aim = get<uint8_t>();
    if (aim > uint8_t(Aim::projection_map)) damaged("a setting in it is not valid");
    s.aim = Aim(aim);
    s.target_budget = get<int32_t>();
    s.part.index = get<uint32_t>();
    s.part.count = get<uint32_t>();
    if (s.part.index >= s.part.count || s.part.count > PhotonPart::maximum_count)
      damaged("a setting in it is not valid");
    return s;
  }

  PhotonMap get_map(MapReport& report) {
    report.rays = get<uint64_t>();
    report.target_count = size_t(get<uint64_t>());
    const auto lights = get<uint64_t>();
    need(lights, bytes_per_light);
    report.lights.resize(lights);
    for (LightCounts& c : report.lights) {
      for (uint64_t* count :
           {&c.emitted, &c.stored, &c.nothing, &c.escaped, &c.absorbed, &c.too_long, &c.stopped})
        *count = get<uint64_t>();
      c.stored_flux = get<double>();
      if (!std::isfinite(c.stored_flux)) damaged("a light's flux is not finite");
    }
    const auto count = get<uint64_t>();
    need(count, bytes_per_photon);
    if (count > KdTree<3, Vec3f, Photon>::max_size) damaged("it holds too many photons");
    auto positions = get_array<Vec3f>(count);
    auto photons = get_array<Photon>(count);
    check_photons(positions, photons);
    return {std::move(positions), std::move(photons)};
  }

  void check_photons(const std::vector<Vec3f>& positions,
                     const std::vector<Photon>& photons) const {
    for (size_t i = 0; i < photons.size(); ++i) {
      const Photon& photon = photons[i];
      bool valid = max_abs(positions[i]) < KdBuckets::max_coordinate && is_finite(positions[i]) &&
                   photon.distance >= 0 && photon.on_front <= 1;
      for (const float lane : photon.flux) valid = valid && std::isfinite(lane) && lane >= 0;
      if (!valid) damaged(fmt::format("photon {} is not valid", i));
    }
  }

  std::string path_;
  std::vector<uint8_t> bytes_;
  std::span<const uint8_t> rest_;
};

std::string text_of(const Bounds3f& b) {
  return fmt::format("{:.5g} {:.5g} {:.5g} to {:.5g} {:.5g} {:.5g}", b.min.x, b.min.y, b.min.z,
                     b.max.x, b.max.y, b.max.z);
}

std::string text_of(const Vec3f& v) { return fmt::format("{:.4g} {:.4g} {:.4g};", v.x, v.y, v.z); }

/// How a surface scatters: its albedo, and where it sends a few directions from either side.
std::string text_of(const Bsdf& bsdf) {
  BsdfContext context;
  context.move_to({.uv = {0.5f, 0.5f}});
  std::string text;
  for (const float side : {1.0f, -1.0f}) {
    const Vec3f wo = normalize(Vec3f(0.3f, 0.2f, side));
    const Spectrum albedo = bsdf.albedo(context, wo, Lobes::all);
    text += fmt::format("{:.3g} {:.3g} {:.3g};", albedo[0], albedo[1], albedo[2]);
    for (const float u : {0.02f, 0.98f})
      text += text_of(bsdf.sample(context, wo, u, {0.4f, 0.7f}, Lobes::all).wi);
  }
  return text;
}

/// What a light sends out: its power and a few of its rays.
std::string text_of(const Light& light) {
  std::string text = fmt::format("{:.4g};", light.power().sum());
  for (const float u : {0.2f, 0.7f}) {
    const EmissionSample ray = light.sample_emission({u, 0.4f}, {0.6f, u});
    text += text_of(ray.point.position) + text_of(ray.direction);
  }
  return text;
}

/// Of what tells scenes apart: shapes, where instances stand, how surfaces scatter, what lights
/// send out. Rounded, so that the last bits of another build make no difference.
uint64_t digest_of(const Scene& scene) {
  std::string text;
  for (uint32_t i = 0; i < scene.surface_count(); ++i)
    text += text_of(scene.tracer().shape(i).bounds()) + text_of(*scene.surface(i).bsdf);
  for (const Instance& instance : scene.tracer().geometry().instances)
    for (const Vec3f& p : {Vec3f(0, 0, 0), Vec3f(1, 0, 0), Vec3f(0, 1, 0), Vec3f(0, 0, 1)})
      text += text_of(instance.world_from_group.point(p));
  for (const auto& light : scene.lights()) text += text_of(*light);
  return checksum({reinterpret_cast<const uint8_t*>(text.data()), text.size()});
}

}  // namespace

std::string scene_fingerprint(const Scene& scene) {
  size_t triangles = 0;
  for (uint32_t i = 0; i < scene.tracer().shape_count(); ++i)
    if (const TriangleMesh* mesh = scene.tracer().shape(i).mesh())
      triangles += mesh->triangles.size();
  Spectrum power;
  for (const auto& light : scene.lights()) power += light->power();
  // Maps for irradiance have photons on mirrors and glass too.
  return fmt::format(
      "{} shapes, {} triangles, bounds {}, {} lights of {:.5g} {:.5g} {:.5g} W, digest {:016x}{}",
      scene.surface_count(), triangles, text_of(scene.tracer().bounds()), scene.lights().size(),
      power[0], power[1], power[2], digest_of(scene),
      scene.film().quantity == Quantity::irradiance ? ", for irradiance" : "");
}

void write_photon_file(const std::string& path, const StoredPhotons& photons) {
  Writer writer;
  writer.put(magic);
  writer.put(byte_order_mark);
  writer.put(version);
  writer.put_text(photons.scene);
  writer.put_text(photons.fingerprint);
  writer.put(photons.seed);
  writer.put_settings(photons.settings);
  writer.put_map(photons.maps.global, photons.maps.global_report);
  writer.put_map(photons.maps.caustic, photons.maps.caustic_report);
  writer.put_checksum();
  write_file_atomically(path, writer.bytes());
}

StoredPhotons read_photon_file(const std::string& path) { return Reader(path).read(); }

}  // namespace kaustik
