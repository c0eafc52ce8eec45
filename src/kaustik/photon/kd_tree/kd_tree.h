#pragma once
// The general kd-tree: points of any dimension with data attached to each.

#include <bit>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stop_token>
#include <type_traits>
#include <utility>
#include <vector>

#include "kaustik/base/error.h"
#include "kaustik/base/parallel.h"
#include "kaustik/base/vec.h"
#include "kaustik/photon/kd_tree/kd_tree_buckets.h"
#include "kaustik/photon/kd_tree/kd_tree_forest.h"
#include "kaustik/photon/kd_tree/kd_tree_neighbors.h"

namespace kaustik {

/// Accepts every item.
struct KdAcceptAll {
  bool operator()(uint32_t) const { return true; }
};

/// A kd-tree over points of `Dim` coordinates; equal keys are allowed, at most 2^31 items.
///
/// `Key` is anything whose key[axis] is a number. `Data` belongs to a key; it is default
/// constructible, and the tree keeps it in its own order: data(index). An index stays valid until
/// the next insert() or optimise(). `Metric` replaces the squared Euclidean distance (see
/// EuclideanMetric). A tree with Key = Vec3f and the Euclidean metric is searched with vector
/// instructions once it is optimised.
///
/// The renderer fills its trees by assign(), and asks nearest() and within(). All else is there for
/// programs that use the tree by itself, as the thesis has it.
///
/// Searches may run in parallel with each other. All of them return items strictly nearer than
/// their limit. A predicate rejects items during the search. It is either
///   bool accept(uint32_t index), or
///   uint32_t accept(uint32_t first, uint32_t mask): bit i of `mask` stands for item first + i, at
///   most 16 of them; returns the mask of those that count.
/// It is asked only about items near enough to count.
///
/// Keys that are not finite (or, for Vec3f, not below KdBuckets::max_coordinate) throw an Error; a
/// query with such a key is a programming error.
template <int Dim, typename Key, typename Data, typename Metric = EuclideanMetric<Dim, Key>>
class KdTree {
 public:
  using Distance = typename Metric::Distance;
  using Neighbors = KdNeighbors<Distance>;
  static constexpr Distance unlimited = Neighbors::unlimited;
  static constexpr size_t max_size = size_t(1) << 31;
  /// Whether optimise() makes buckets for vector instructions.
  static constexpr bool has_buckets =
      Dim == 3 && std::is_same_v<Key, Vec3f> && std::is_same_v<Metric, EuclideanMetric<Dim, Key>>;

  /// An item that a search found.
  struct Found {
    Key key;
    const Data& data;
    Distance distance_sq;  ///< 0 from find() and range()
    uint32_t index;
  };
  /// What a search found, to be iterated over.
  class Matches {
   public:
    class Iterator {
     public:
      Iterator(const Matches& matches, size_t i) : matches_(&matches), i_(i) {}
      Found operator*() const { return (*matches_)[i_]; }
      Iterator& operator++() { return ++i_, *this; }
      bool operator==(const Iterator& other) const { return i_ == other.i_; }

     private:
      const Matches* matches_;
      size_t i_;
    };
    Iterator begin() const { return {*this, 0}; }
    Iterator end() const { return {*this, size()}; }
    size_t size() const { return hits_.size(); }
    bool empty() const { return hits_.empty(); }
    Found operator[](size_t i) const {
      const auto [distance_sq, index] = hits_[i];
      return {tree_->key(index), tree_->data(index), distance_sq, index};
    }

   private:
    friend class KdTree;
    explicit Matches(const KdTree& tree) : tree_(&tree) {}
    const KdTree* tree_;
    std::vector<std::pair<Distance, uint32_t>> hits_;
  };

  explicit KdTree(Metric metric = {}) : metric_(std::move(metric)) {}
  /// A tree that was optimised before, with the data of its points in its order.
  KdTree(KdBuckets buckets, KeptArray<Data> data) requires has_buckets
      : buckets_(std::move(buckets)),
        data_(std::move(data)) {
    assert(buckets_.size() == data_.size());
  }

  /// Replaces all items, and optimises: the quickest way to fill a tree. data[i] belongs to
  /// keys[i]. Where `stop` is requested the tree is left empty.
  void assign(std::vector<Key> keys, std::vector<Data> data, const std::stop_token& stop = {});
  void insert(const Key& key, Data data);
  /// Removes one item with this key that the predicate accepts; false if there is none.
  template <typename Accept = KdAcceptAll>
  bool remove(const Key& key, const Accept& accept = {});
  void remove_at(uint32_t index);
  /// Balances the tree, drops what was removed, and builds the buckets; in parallel, with the same
  /// result for any number of threads.
  void optimise();

  size_t size() const { return data_.size() - removed_; }
  bool empty() const { return size() == 0; }
  Key key(uint32_t index) const;
  const Data& data(uint32_t index) const { return data_[index]; }
  /// May be changed as long as no search runs.
  Data& data(uint32_t index) { return data_.own()[index]; }
  /// Where vector code looks at many items at once. All of them are there after assign() or
  /// optimise().
  const KdBuckets& buckets() const requires has_buckets { return buckets_; }
  /// All data by index, removed items included (there are none after optimise()).
  std::span<const Data> data() const { return data_.all(); }
  bool removed(uint32_t index) const;
  /// Memory of keys, data and structure, of its own; not of anything that Data points to.
  size_t size_in_bytes() const {
    return buckets_.size_in_bytes() + forest_.size_in_bytes() + data_.own_bytes();
  }

  /// All items with this key.
  Matches find(const Key& key) const { return range(key, key); }
  /// All items in the closed box.
  Matches range(const Key& lower, const Key& upper) const;
  /// The k nearest items with distance_sq < limit_sq, the nearest first.
  template <typename Accept = KdAcceptAll>
  Matches nearest(const Key& query, size_t k, Distance limit_sq = unlimited,
                  const Accept& accept = {}) const;
  /// The same, unsorted, into memory that is used again: the fast way.
  template <typename Accept = KdAcceptAll>
  void nearest(const Key& query, size_t k, Distance limit_sq, const Accept& accept,
               Neighbors& neighbors) const;
  /// Calls visit(index, distance_sq) for all items with distance_sq < radius_sq.
  template <typename Visit>
  void within(const Key& query, Distance radius_sq, const Visit& visit) const;

 private:
  static void check(const Key& key);
  void check_size(size_t size) const;
  uint32_t forest_begin() const { return uint32_t(buckets_.size()); }
  void build(std::vector<Key> keys, std::vector<Data> data, const std::stop_token& stop);
  template <typename Visit>
  void visit_inside(const Key& lower, const Key& upper, const Visit& visit) const;

  Metric metric_;
  KdBuckets buckets_;                  ///< items 0 … buckets_.size() - 1
  KdForest<Dim, Key, Metric> forest_;  ///< the items after them
  KeptArray<Data> data_;
  size_t removed_ = 0;
};

}  // namespace kaustik

#include "kaustik/photon/kd_tree/kd_tree_impl.h"
