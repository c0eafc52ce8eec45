#include "kaustik/render/team_messages.h"

#include <numeric>

#include "kaustik/base/bytes.h"

namespace kaustik {

std::vector<uint32_t> TeamOrder::of_member(uint32_t rank) const {
  const uint64_t begin =
      std::accumulate(shares.begin(), shares.begin() + std::ptrdiff_t(rank), uint64_t{0});
  const uint64_t end = begin + shares[rank];
  std::vector<uint32_t> own;
  uint64_t place = 0;
  for (const PassRange& range : passes.ranges())
    for (uint32_t pass = range.begin; pass < range.end; ++pass, ++place)
      if (place >= begin && place < end) own.push_back(pass);
  return own;
}

std::vector<uint8_t> TeamOrder::bytes() const {
  ByteWriter writer;
  writer.put(kind);
  writer.put(end);
  writer.put_array(passes.ranges());
  writer.put_array(shares);
  writer.put(lessons.passes);
  writer.put_array(lessons.bytes);
  return writer.take();
}

TeamOrder TeamOrder::from(const std::vector<uint8_t>& bytes) {
  ByteReader reader(bytes, "an order of the leading process");
  TeamOrder order;
  order.kind = reader.get<Kind>();
  order.end = reader.get<SessionEnd>();
  for (const PassRange& range : reader.get_array<PassRange>()) order.passes.add(range);
  order.shares = reader.get_array<uint32_t>();
  order.lessons.passes = reader.get<uint32_t>();
  order.lessons.bytes = reader.get_array<uint8_t>();
  reader.expect_end();
  return order;
}

std::vector<uint8_t> TeamReport::bytes() const {
  ByteWriter writer;
  writer.put(uint64_t(passes.size()));
  for (const DonePass& done : passes) {
    writer.put(done.pass);
    writer.put_array(done.taught);
  }
  writer.put(seconds);
  writer.put(uint8_t(is_stopped));
  for (const uint64_t count : {rays, photons, dropped}) writer.put(count);
  return writer.take();
}

TeamReport TeamReport::from(const std::vector<uint8_t>& bytes) {
  ByteReader reader(bytes, "the report of a process");
  TeamReport report;
  for (auto left = reader.get<uint64_t>(); left > 0; --left) {
    const auto pass = reader.get<uint32_t>();
    report.passes.push_back({pass, reader.get_array<uint8_t>()});
  }
  report.seconds = reader.get<double>();
  report.is_stopped = reader.get_flag();
  for (uint64_t* count : {&report.rays, &report.photons, &report.dropped})
    *count = reader.get<uint64_t>();
  reader.expect_end();
  return report;
}

}  // namespace kaustik
