#include "kaustik/photon/photon_sort.h"

#include <algorithm>
#include <queue>
#include <utility>

#include "kaustik/base/bytes.h"
#include "kaustik/base/file.h"

namespace kaustik {
namespace {

/// Of a run that is merged, at most.
constexpr size_t most_records_ahead = size_t{1} << 15;

struct Numbered {
  uint64_t place;
  uint32_t index;
};

}  // namespace

/// A run on the disk, from its first photon to its last.
class PhotonSort::RunReader {
 public:
  RunReader(const ScratchFile& file, Run run, const PhotonOrder& order, size_t ahead)
      : file_(&file), run_(run), order_(&order), ahead_(ahead) {
    next();
  }
  bool at_end() const { return at_ == records_.size(); }
  const PhotonRecord& record() const { return records_[at_]; }
  void next() {
    if (at_ < records_.size()) ++at_;
    if (at_ == records_.size() && run_.begin < run_.end) {
      records_.resize(
          size_t(std::min<uint64_t>(ahead_, (run_.end - run_.begin) / sizeof(PhotonRecord))));
      const std::span<uint8_t> out(reinterpret_cast<uint8_t*>(records_.data()),
                                   records_.size() * sizeof(PhotonRecord));
      file_->read(run_.begin, out);
      run_.begin += out.size();
      at_ = 0;
    }
    if (!at_end()) place_ = order_->place_on_curve(record().position());
  }
  bool is_after(const RunReader& other) const {
    if (place_ != other.place_) return place_ > other.place_;
    return PhotonOrder::is_before(other.record(), record());
  }

 private:
  const ScratchFile* file_;
  Run run_;
  const PhotonOrder* order_;
  size_t ahead_;
  std::vector<PhotonRecord> records_;
  size_t at_ = 0;
  uint64_t place_ = 0;
};

PhotonSort::PhotonSort(const PhotonBounds& bounds, const SortMemory& memory)
    : order_(bounds), memory_(memory) {}

PhotonSort::~PhotonSort() = default;

void PhotonSort::add(const PhotonRecord& record) {
  if (records_.size() >= memory_.photons) keep_run();
  records_.push_back(record);
}

void PhotonSort::sort_records() {
  std::vector<Numbered> order(records_.size());
  for (uint32_t i = 0; i < order.size(); ++i)
    order[i] = {order_.place_on_curve(records_[i].position()), i};
  std::sort(order.begin(), order.end(), [this](const Numbered& a, const Numbered& b) {
    if (a.place != b.place) return a.place < b.place;
    return PhotonOrder::is_before(records_[a.index], records_[b.index]);
  });
  // In place, by the cycles of the permutation: there may be no room for all of them twice.
  for (uint32_t first = 0; first < order.size(); ++first) {
    if (order[first].index == first) continue;
    const PhotonRecord moved = records_[first];
    uint32_t to = first;
    while (order[to].index != first) {
      const uint32_t from = order[to].index;
      records_[to] = records_[from];
      order[to].index = to;
      to = from;
    }
    records_[to] = moved;
    order[to].index = to;
  }
}

void PhotonSort::keep_run() {
  sort_records();
  if (!file_) file_ = std::make_unique<ScratchFile>(memory_.beside);
  const uint64_t begin = runs_.empty() ? 0 : runs_.back().end;
  file_->append(bytes_in(std::span<const PhotonRecord>(records_)));
  runs_.push_back({begin, begin + records_.size() * sizeof(PhotonRecord)});
  records_.clear();
}

void PhotonSort::drain(size_t at_a_time,
                       const std::function<void(std::span<const PhotonRecord>)>& take) {
  if (runs_.empty()) {
    sort_records();
    for (size_t first = 0; first < records_.size(); first += at_a_time)
      take(std::span(records_).subspan(first, std::min(at_a_time, records_.size() - first)));
    records_.clear();
    return;
  }
  if (!records_.empty()) keep_run();
  records_ = std::vector<PhotonRecord>();  // `{}` would keep its memory
  const size_t ahead = std::clamp(memory_.photons / runs_.size(), size_t{1}, most_records_ahead);
  std::vector<RunReader> readers;
  for (const Run& run : runs_) readers.emplace_back(*file_, run, order_, ahead);
  const auto is_after = [&](size_t a, size_t b) { return readers[a].is_after(readers[b]); };
  std::priority_queue<size_t, std::vector<size_t>, decltype(is_after)> next(is_after);
  for (size_t i = 0; i < readers.size(); ++i) next.push(i);
  std::vector<PhotonRecord> merged;
  merged.reserve(at_a_time);
  while (!next.empty()) {
    const size_t first = next.top();
    next.pop();
    merged.push_back(readers[first].record());
    readers[first].next();
    if (!readers[first].at_end()) next.push(first);
    if (merged.size() == at_a_time) {
      take(merged);
      merged.clear();
    }
  }
  if (!merged.empty()) take(merged);
  runs_.clear();
  file_.reset();
}

}  // namespace kaustik
