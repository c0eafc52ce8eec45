// Merging by vector instructions finds what a loop over all light vertices finds.

#include "kaustik/vcm/merging/matt_merging.h"

#include <gtest/gtest.h>

#include <numeric>
#include <random>

namespace kaustik {
namespace {

PathWeights all_techniques() {
  PathWeights::Settings settings;
  settings.techniques = {true, true, true, true, true};
  settings.light_paths = 1000;
  settings.connections = 0.5f;
  settings.merge_area = 1e-3f;
  settings.accepted_area = 1e-2f;
  return PathWeights(settings);
}

/// Paths of a light, a diffuse event and a vertex that merges, on two floors that lie close, of
/// which half of the upper one is aslant, and a wall.
LightVertices light_vertices(uint32_t count) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> unit(0, 1);
  LightVertices light;
  light.path_count = count;
  std::vector<Vec3f> positions;
  std::vector<LightVertexData> data;
  for (uint32_t i = 0; i < count; ++i) {
    LightVertexData d;
    const int where = int(random() % 3);
    const Vec3f normal =
        where < 2
            ? normalize({where == 0 && i % 2 == 0 ? 0.7f : 0.0f, 0, where == 0 ? 1.0f : -1.0f})
            : Vec3f(1, 0, 0);
    const float a = unit(random), b = unit(random);
    positions.push_back(where < 2 ? Vec3f(a, b, where == 0 ? 0.0f : -0.02f)
                                  : Vec3f(0.5f, a, b * 0.2f));
    d.side = CoarseNormal(normal);
    d.direction = PackedDirection(normalize(normal + Vec3f(0.3f, 0.5f, 0.2f)));
    for (int lane = 0; lane < 3; ++lane) d.flux.lanes[size_t(lane)] = unit(random);
    d.specular = unit(random) < 0.3f;
    d.before = uint16_t(2 + random() % 3);
    d.path = uint32_t(light.vertices.size());
    d.pdf_next_event = unit(random);
    for (int k = 0; k <= d.before; ++k) {
      PathVertex vertex;
      vertex.pdf_camera = 0.1f + unit(random);
      vertex.pdf_light = 0.1f + unit(random);
      vertex.to_previous = 0.1f + unit(random);
      vertex.spread = unit(random);
      vertex.delta = k > 0 && k < d.before && d.specular;
      light.vertices.push_back(vertex);
    }
    data.push_back(d);
  }
  light.tree = {std::move(positions), std::move(data)};
  return light;
}

/// A disk, the vertex that sees it, and what it plans.
struct Seen {
  MattDisk disk;
  PathVertex vertex;
  float area = 0, survival = 1;
};

/// What a light vertex adds at a disk, by the whole weights.
void add_by_definition(const LightVertices& light, const PathWeights& weights, const Seen& seen,
                       uint32_t number, MattLight& result) {
  const MattDisk& disk = seen.disk;
  const LightVertexData& data = light.tree.tree().data(number);
  const Vec3f offset = light.tree.tree().key(number) - disk.center;
  const float share = length_sq(offset) / sqr(disk.radius);
  const float cosine = dot(data.side.unpack(), disk.normal);
  if (!(share < 1) || std::fabs(dot(offset, disk.normal)) > disk.flatness ||
      cosine <= disk.least_cosine || data.before > disk.most_before || !disk.edges.hold(offset))
    return;
  const std::span<const PathVertex> before = light.before(data);
  PathHalves path;
  path.camera = {&seen.vertex, 1};
  path.light = before;
  path.pdf_light_last = light.at(data).pdf_light;
  path.pdf_camera_last =
      dot(data.side.unpack(), data.direction.unpack()) * inv_pi * light.at(data).to_previous;
  path.pdf_camera_before_last = before[before.size() - 2].pdf_camera;
  path.pdf_next_event = data.pdf_next_event;
  path.first_merge_area = seen.area;
  path.first_survival = seen.survival;
  const Spectrum flux = data.flux.spectrum() * (weights.merge(path) * cosine);
  MattLight::Sum& sum = data.specular ? result.after_specular : result.other;
  sum.wide += flux * ((1 - share) * (1 + dot(disk.slope, offset)));
  sum.narrow += flux * (std::max(0.0f, 1 - share / sqr(narrow_radius)) *
                        (1 + dot(disk.narrow_slope, offset)));
}

MattLight by_definition(const LightVertices& light, const PathWeights& weights, const Seen& seen) {
  MattLight result;
  for (uint32_t i = 0; i < light.tree.tree().size(); ++i)
    add_by_definition(light, weights, seen, i, result);
  return result;
}

void expect_same(const Spectrum& found, const Spectrum& expected) {
  for (int lane = 0; lane < 3; ++lane)
    EXPECT_NEAR(found[lane], expected[lane], 1e-3f * std::fabs(expected[lane]) + 1e-6f);
}

TEST(MattMerging, FindsWhatALoopFinds) {
  const PathWeights weights = all_techniques();
  const LightVertices light = light_vertices(3001);
  const MattMerging merging(light, weights);
  std::mt19937 random(2);
  std::uniform_real_distribution<float> unit(0, 1);
  double found = 0;
  for (int i = 0; i < 300; ++i) {
    Seen seen;
    MattDisk& disk = seen.disk;
    disk.normal = i % 3 == 0 ? Vec3f(1, 0, 0) : Vec3f(0, 0, i % 3 == 1 ? 1.0f : -1.0f);
    disk.center = i % 3 == 0 ? Vec3f(0.5f, unit(random), 0.2f * unit(random))
                             : Vec3f(unit(random), unit(random), i % 3 == 1 ? 0.0f : -0.02f);
    disk.radius = 0.02f + 0.2f * unit(random);
    disk.flatness = 0.3f * disk.radius;
    disk.least_cosine = 0.5f;
    if (i % 2 == 0) disk.most_before = 3;
    if (i % 5 < 2) {
      const Frame frame(disk.normal);
      disk.edges.count = size_t(1 + i % 5);
      disk.edges.edges[0] = {frame.x, 0.3f * disk.radius * unit(random)};
      disk.edges.edges[1] = {frame.y * -1.0f, 0.6f * disk.radius};
      disk.slope = frame.x * (-0.5f / disk.radius);
      disk.narrow_slope = frame.y * (0.4f / disk.radius);
    }
    seen.vertex.pdf_camera = 1 + 50 * unit(random);
    seen.area = pi * sqr(disk.radius);
    seen.survival = 0.1f + 0.9f * unit(random);
    disk.weights = weights.matt_vertex({&seen.vertex, 1}, seen.area, seen.survival);
    const MattLight light_there = merging.merge(disk);
    const MattLight expected = by_definition(light, weights, seen);
    expect_same(light_there.after_specular.wide, expected.after_specular.wide);
    expect_same(light_there.after_specular.narrow, expected.after_specular.narrow);
    expect_same(light_there.other.wide, expected.other.wide);
    expect_same(light_there.other.narrow, expected.other.narrow);
    found += double(expected.other.wide.sum());
  }
  EXPECT_GT(found, 100);
}

/// A disk that many vertices lie in.
Seen middle_of_the_floor(const PathWeights& weights) {
  Seen seen;
  MattDisk& disk = seen.disk;
  disk.normal = Vec3f(0, 0, 1);
  disk.center = Vec3f(0.5f, 0.4f, 0);
  disk.radius = 0.3f;
  disk.flatness = 0.3f * disk.radius;
  disk.least_cosine = 0.5f;
  seen.vertex.pdf_camera = 20;
  seen.area = pi * sqr(disk.radius);
  disk.weights = weights.matt_vertex({&seen.vertex, 1}, seen.area, seen.survival);
  return seen;
}

/// Of focused vertices alone merges what merges of them among all.
TEST(MattMerging, OfSomeVertices) {
  const PathWeights weights = all_techniques();
  const LightVertices light = light_vertices(3001);
  const SidedTree<LightVertexData> focused = focused_vertices(light);
  EXPECT_LT(focused.size(), light.tree.size() / 2);
  const MattMerging of_all(light, weights), of_focused(light, focused, weights);
  std::mt19937 random(3);
  std::uniform_real_distribution<float> unit(0, 1);
  int empty = 0, found = 0;
  for (int i = 0; i < 300; ++i) {
    MattDisk disk;
    disk.normal = {0, 0, 1};
    disk.center = {2 * unit(random), unit(random), 0};
    disk.radius = disk.flatness = 0.1f * unit(random);
    disk.least_cosine = 0.5f;
    disk.only_after_specular = true;
    const MattLight expected = of_all.merge(disk), light_there = of_focused.merge(disk);
    expect_same(light_there.after_specular.wide, expected.after_specular.wide);
    expect_same(light_there.after_specular.narrow, expected.after_specular.narrow);
    EXPECT_TRUE(light_there.other.wide.is_zero());
    if (of_focused.may_merge(disk.center, disk.radius)) {
      ++found;
    } else {
      ++empty;
      EXPECT_TRUE(expected.after_specular.wide.is_zero());
    }
  }
  EXPECT_GT(empty, 50);
  EXPECT_GT(found, 50);
}

/// Blocks that a stop has left unfilled are never read.
TEST(MattMerging, NothingMergesOnceStopped) {
  const PathWeights weights = all_techniques();
  const LightVertices light = light_vertices(3001);
  const MattDisk disk = middle_of_the_floor(weights).disk;
  std::stop_source stop;
  EXPECT_FALSE(MattMerging(light, weights, stop.get_token()).merge(disk).other.wide.is_zero());
  stop.request_stop();
  EXPECT_TRUE(MattMerging(light, weights, stop.get_token()).merge(disk).other.wide.is_zero());
}

TEST(MattMerging, DrawsVerticesByWhatTheyAdd) {
  const PathWeights weights = all_techniques();
  const LightVertices light = light_vertices(3001);
  const MattMerging merging(light, weights);
  const Seen seen = middle_of_the_floor(weights);
  const MattDisk& disk = seen.disk;
  std::vector<MattMerging::Factors> each;
  const MattLight found = merging.merge(disk, &each);
  const Spectrum reflected(0.9f, 0, 0, 0);  // one lane that draws
  constexpr int draws = 20'000;
  for (const auto kind : {MattMerging::other, MattMerging::after_specular}) {
    const auto light_of = [&](const MattLight& all) {
      const MattLight::Sum& sum = kind == MattMerging::other ? all.other : all.after_specular;
      return sum.wide * reflected;
    };
    std::vector<int> drawn(light.tree.tree().size());
    for (int i = 0; i < draws; ++i) {
      LaneDraw draw(light_of(found), (float(i) + 0.5f) / draws);
      merging.offer(each, kind, reflected, draw);
      draw.remaining(light_of(found), [&](size_t number) {
        ++drawn[number];
        return true;
      });
    }
    int counting = 0;
    for (uint32_t i = 0; i < drawn.size(); ++i) {
      MattLight of_vertex;
      add_by_definition(light, weights, seen, i, of_vertex);
      // Each is drawn over one interval, with two ends; a thousandth is rounding.
      const float expected = light_of(of_vertex)[0] / light_of(found)[0];
      if (expected > 0)
        EXPECT_NEAR(drawn[i], draws * expected, 2 + 1e-3 * draws * expected) << i;
      else
        EXPECT_EQ(drawn[i], 0) << i;
      counting += expected > 0;
    }
    EXPECT_EQ(std::accumulate(drawn.begin(), drawn.end(), 0), draws);
    EXPECT_GT(counting, 50);
  }
}

TEST(MattMerging, OfNothing) { EXPECT_TRUE(MattMerging().merge(MattDisk()).other.wide.is_zero()); }

}  // namespace
}  // namespace kaustik
