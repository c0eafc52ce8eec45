// Merging with vector instructions; compiled once per instruction set, of which Highway chooses at
// run time.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kaustik/vcm/merging/matt_merging.cpp"
#include <hwy/foreach_target.h>
// Highway asks for this order.
#include <hwy/highway.h>

#include <algorithm>
#include <bit>

#include "kaustik/base/parallel.h"
#include "kaustik/vcm/merging/matt_merging.h"

HWY_BEFORE_NAMESPACE();
namespace kaustik::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

using Tag = hn::CappedTag<float, KdBuckets::bucket_size>;
using Vec = hn::Vec<Tag>;
using Mask = hn::Mask<Tag>;

/// Parts of 127, as numbers.
HWY_INLINE Vec load_parts(const int8_t* parts) {
  const Tag d;
  const hn::RebindToSigned<Tag> di;
  const hn::Rebind<int8_t, Tag> d8;
  return hn::ConvertTo(d, hn::PromoteTo(di, hn::LoadU(d8, parts)));
}

HWY_INLINE Vec load_counts(const uint16_t* counts) {
  const Tag d;
  const hn::RebindToSigned<Tag> di;
  const hn::Rebind<uint16_t, Tag> d16;
  return hn::ConvertTo(d, hn::PromoteTo(di, hn::LoadU(d16, counts)));
}

using EachFactors = std::vector<MattMerging::Factors>;

/// MattLight::Sum, lane by lane.
class Sum {
 public:
  HWY_INLINE Sum() {
    for (size_t lane = 0; lane < size_t(Spectrum::lane_count); ++lane)
      wide_[lane] = narrow_[lane] = hn::Zero(Tag());
  }
  HWY_INLINE void add(const MattMerging::Block& block, size_t i, Vec wide, Vec narrow) {
    const Tag d;
    for (size_t lane = 0; lane < size_t(Spectrum::lane_count); ++lane) {
      const Vec flux = hn::Load(d, block.flux[lane] + i);
      wide_[lane] = hn::MulAdd(flux, wide, wide_[lane]);
      narrow_[lane] = hn::MulAdd(flux, narrow, narrow_[lane]);
    }
  }
  HWY_INLINE MattLight::Sum total() const {
    const Tag d;
    MattLight::Sum sum;
    for (int lane = 0; lane < Spectrum::lane_count; ++lane) {
      sum.wide.set(lane, hn::GetLane(hn::SumOfLanes(d, wide_[lane])));
      sum.narrow.set(lane, hn::GetLane(hn::SumOfLanes(d, narrow_[lane])));
    }
    return sum;
  }

 private:
  Vec wide_[Spectrum::lane_count], narrow_[Spectrum::lane_count];
};

struct Sums {
  HWY_INLINE Sums() {}
  Sum after_specular, other;
};

HWY_INLINE void add_block(const KdBuckets::Bucket& points, const MattMerging::Block& block,
                          const MattDisk& disk, Sums& sums, MattMerging::Factors* factors) {
  if (disk.only_after_specular && block.after_specular == 0) return;
  const Tag d;
  const auto dot_with = [&](const Vec3f& v, Vec x, Vec y, Vec z) HWY_ATTR {
    return hn::MulAdd(x, hn::Set(d, v.x),
                      hn::MulAdd(y, hn::Set(d, v.y), hn::Mul(z, hn::Set(d, v.z))));
  };
  // Where surfaces stand across the disk, they have more area than it.
  Vec cosine = hn::Set(d, 1.0f);
  if (block.same_side) {
    const Vec3f side(block.side[0][0], block.side[1][0], block.side[2][0]);
    const float of_all = dot(side, disk.normal) / block.side_length[0];
    if (!(of_all > disk.least_cosine)) return;
    cosine = hn::Set(d, std::min(1.0f, of_all));
  }
  const float radius_sq = sqr(disk.radius);
  for (size_t i = 0; i < MattMerging::Block::size; i += hn::Lanes(d)) {
    const Vec x = hn::Sub(hn::Load(d, points.x + i), hn::Set(d, disk.center.x));
    const Vec y = hn::Sub(hn::Load(d, points.y + i), hn::Set(d, disk.center.y));
    const Vec z = hn::Sub(hn::Load(d, points.z + i), hn::Set(d, disk.center.z));
    const Vec distance_sq = hn::MulAdd(x, x, hn::MulAdd(y, y, hn::Mul(z, z)));
    Mask counts = hn::Lt(distance_sq, hn::Set(d, radius_sq));
    if (hn::AllFalse(d, counts)) continue;
    counts =
        hn::And(counts, hn::Le(hn::Abs(dot_with(disk.normal, x, y, z)), hn::Set(d, disk.flatness)));
    if (!block.same_side) {
      cosine =
          hn::Min(hn::Set(d, 1.0f),
                  hn::Div(dot_with(disk.normal, load_parts(block.side[0] + i),
                                   load_parts(block.side[1] + i), load_parts(block.side[2] + i)),
                          hn::Load(d, block.side_length + i)));
      counts = hn::And(counts, hn::Gt(cosine, hn::Set(d, disk.least_cosine)));
    }
    if (block.most_before > disk.most_before)
      counts = hn::And(counts,
                       hn::Le(load_counts(block.before + i), hn::Set(d, float(disk.most_before))));
    for (size_t edge = 0; edge < disk.edges.count; ++edge)
      counts = hn::And(counts, hn::Ge(dot_with(disk.edges.edges[edge].inward, x, y, z),
                                      hn::Set(d, -disk.edges.edges[edge].distance)));
    const Vec kernel = hn::NegMulAdd(distance_sq, hn::Set(d, 1 / radius_sq), hn::Set(d, 1.0f));
    Vec others = hn::MulAdd(hn::Load(d, block.beyond + i), hn::Set(d, disk.weights.on_beyond),
                            hn::Set(d, disk.weights.base));
    if (disk.weights.on_connection > 0)
      others = hn::MulAdd(hn::Load(d, block.connection + i), hn::Set(d, disk.weights.on_connection),
                          others);
    const Vec each = hn::Div(cosine, others);
    Vec wide = hn::Mul(each, kernel);
    // 1 − a d² by 1 − d², as far as that is not negative.
    constexpr float areas = 1 / (narrow_radius * narrow_radius);
    Vec narrow = hn::Mul(
        each, hn::Max(hn::Zero(d), hn::MulSub(hn::Set(d, areas), kernel, hn::Set(d, areas - 1))));
    if (disk.edges.count > 0) {
      wide = hn::MulAdd(wide, dot_with(disk.slope, x, y, z), wide);
      narrow = hn::MulAdd(narrow, dot_with(disk.narrow_slope, x, y, z), narrow);
    }
    // Last, since points that fill up a bucket are infinitely far away.
    wide = hn::IfThenElseZero(counts, wide);
    narrow = hn::IfThenElseZero(counts, narrow);
    // Buckets hold what is near one another, which often came alike.
    const uint32_t specular = uint32_t(block.after_specular) >> i;
    uint8_t bits[8] = {uint8_t(specular), uint8_t(specular >> 8)};
    const Mask after_specular = hn::LoadMaskBits(d, bits);
    sums.other.add(block, i, hn::IfThenZeroElse(after_specular, wide),
                   hn::IfThenZeroElse(after_specular, narrow));
    if (block.after_specular != 0)
      sums.after_specular.add(block, i, hn::IfThenElseZero(after_specular, wide),
                              hn::IfThenElseZero(after_specular, narrow));
    if (!factors) continue;
    hn::StoreU(wide, d, factors->wide + i);
    uint8_t counting[8] = {};
    hn::StoreMaskBits(d, hn::Gt(wide, hn::Zero(d)), counting);
    factors->counting = uint16_t(factors->counting | (counting[0] | counting[1] << 8) << i);
  }
}

/// Flux times factor of the vertices of a block whose bits are set.
HWY_INLINE Spectrum sum_of(const MattMerging::Block& block, const MattMerging::Factors& factors,
                           unsigned counting) {
  const Tag d;
  Vec sums[Spectrum::lane_count];
  for (Vec& sum : sums) sum = hn::Zero(d);
  for (size_t i = 0; i < MattMerging::Block::size; i += hn::Lanes(d)) {
    uint8_t bits[8] = {uint8_t(counting >> i), uint8_t(counting >> i >> 8)};
    const Vec wide = hn::IfThenElseZero(hn::LoadMaskBits(d, bits), hn::LoadU(d, factors.wide + i));
    for (size_t lane = 0; lane < size_t(Spectrum::lane_count); ++lane)
      sums[lane] = hn::MulAdd(hn::Load(d, block.flux[lane] + i), wide, sums[lane]);
  }
  Spectrum result;
  for (int lane = 0; lane < Spectrum::lane_count; ++lane)
    result.set(lane, hn::GetLane(hn::SumOfLanes(d, sums[lane])));
  return result;
}

void Offer(const MattMerging::Block* blocks, const EachFactors& each, MattMerging::Kind kind,
           const Spectrum& reflected, LaneDraw& draw) {
  const unsigned others = kind == MattMerging::other ? 0xffff : 0;
  for (size_t f = 0; f < each.size() && !draw.is_decided(); ++f) {
    const MattMerging::Factors& factors = each[f];
    const MattMerging::Block& block = blocks[factors.bucket];
    unsigned counting = factors.counting & (block.after_specular ^ others);
    if (counting == 0) continue;
    const auto number = [&] {
      return factors.bucket * KdBuckets::bucket_size + uint32_t(std::countr_zero(counting));
    };
    if (draw.pass_over(number(), sum_of(block, factors, counting) * reflected)) continue;
    for (; counting != 0; counting &= counting - 1) {
      const int i = std::countr_zero(counting);
      const Spectrum flux(block.flux[0][i], block.flux[1][i], block.flux[2][i], block.flux[3][i]);
      draw.offer(number(), flux * factors.wide[i] * reflected);
    }
  }
}

struct Search {
  const KdBuckets& buckets;
  const MattMerging::Block* blocks;
  const MattDisk& disk;
  EachFactors* each;
  Sums sums;
};

MattLight Merge(const KdBuckets& buckets, const MattMerging::Block* blocks, const MattDisk& disk,
                EachFactors* each) {
  Search search{buckets, blocks, disk, each, Sums()};
  const auto take = [](void* context, const uint32_t* numbers, size_t count) HWY_ATTR {
    Search& in = *static_cast<Search*>(context);
    for (size_t i = 0; i < count; ++i) {
      MattMerging::Factors* factors = nullptr;
      if (in.each) factors = &in.each->emplace_back(MattMerging::Factors{numbers[i], 0, {}});
      add_block(in.buckets.bucket(numbers[i]), in.blocks[numbers[i]], in.disk, in.sums, factors);
      if (factors && factors->counting == 0) in.each->pop_back();
    }
  };
  buckets.overlapping(disk.center, sqr(disk.radius), {take, &search});
  return {search.sums.after_specular.total(), search.sums.other.total()};
}

}  // namespace
}  // namespace kaustik::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace kaustik {
namespace {
HWY_EXPORT(Merge);
HWY_EXPORT(Offer);

/// What the light path tells of the weights at its vertex, on a matt surface.
PathWeights::MattMerge matt_merge(const LightVertices& light, const LightVertexData& data,
                                  const PathWeights& weights) {
  static constexpr PathVertex seen{};
  const std::span<const PathVertex> before = light.before(data);
  const PathVertex& vertex = light.at(data);
  PathHalves path;
  path.camera = {&seen, 1};
  path.light = before;
  path.pdf_light_last = vertex.pdf_light;
  path.pdf_camera_last = std::fabs(data.side.dot(data.direction.unpack())) / data.side.length() *
                         inv_pi * vertex.to_previous;
  path.pdf_camera_before_last = before[before.size() - 2].pdf_camera;
  path.pdf_next_event = data.pdf_next_event;
  return weights.matt_merge(path);
}

void fill_block(const LightVertices& light, const SidedTree<LightVertexData>& vertices,
                const PathWeights& weights, size_t begin, MattMerging::Block& block) {
  const auto& tree = vertices.tree();
  const size_t count = std::min(MattMerging::Block::size, tree.size() - begin);
  block = MattMerging::Block();
  block.same_side = true;
  for (size_t i = 0; i < count; ++i) {
    const LightVertexData& data = tree.data(uint32_t(begin + i));
    for (size_t lane = 0; lane < size_t(Spectrum::lane_count); ++lane)
      block.flux[lane][i] = data.flux.lanes[lane];
    const PathWeights::MattMerge merge = matt_merge(light, data, weights);
    block.before[i] = data.before;
    block.most_before = std::max(block.most_before, data.before);
    block.connection[i] = merge.connection;
    block.beyond[i] = merge.beyond;
    const int8_t side[3] = {data.side.x(), data.side.y(), data.side.z()};
    for (size_t axis = 0; axis < 3; ++axis) {
      block.side[axis][i] = side[axis];
      block.same_side = block.same_side && side[axis] == block.side[axis][0];
    }
    block.side_length[i] = data.side.length();
    block.after_specular = uint16_t(block.after_specular | unsigned(data.specular) << i);
  }
}

}  // namespace

MattMerging::MattMerging(const LightVertices& light, const SidedTree<LightVertexData>& vertices,
                         const PathWeights& weights, const std::stop_token& stop)
    : buckets_(&vertices.tree().buckets()) {
  const size_t count = buckets_->bucket_count();
  if (count == 0 || stop.stop_requested()) return;
  auto blocks = std::make_unique_for_overwrite<Block[]>(count);
  parallel_blocks(count, 64, [&](size_t begin, size_t end, size_t) {
    for (size_t i = begin; i < end && !stop.stop_requested(); ++i)
      fill_block(light, vertices, weights, i * Block::size, blocks[i]);
  });
  if (!stop.stop_requested()) blocks_ = std::move(blocks);
}

MattLight MattMerging::merge(const MattDisk& disk, std::vector<Factors>* each) const {
  if (!blocks_) return {};
  return HWY_DYNAMIC_DISPATCH(Merge)(*buckets_, blocks_.get(), disk, each);
}

bool MattMerging::may_merge(const Vec3f& center, float radius) const {
  if (!blocks_) return false;
  bool found = false;
  const auto take = [](void* context, const uint32_t*, size_t count) {
    if (count > 0) *static_cast<bool*>(context) = true;
  };
  buckets_->overlapping(center, sqr(radius), {take, &found});
  return found;
}

void MattMerging::offer(const std::vector<Factors>& each, Kind kind, const Spectrum& reflected,
                        LaneDraw& draw) const {
  if (!each.empty()) HWY_DYNAMIC_DISPATCH(Offer)(blocks_.get(), each, kind, reflected, draw);
}

}  // namespace kaustik
#endif
