#include "kaustik/render/film_reduction.h"

#include <algorithm>

#include "kaustik/base/bytes.h"

namespace kaustik {
namespace {

constexpr size_t most_bytes = size_t{64} << 20;

std::vector<uint8_t> bytes_of(const FilmFacts& facts) {
  ByteWriter writer;
  writer.put_array(facts.passes.ranges());
  writer.put(facts.samples_per_pixel);
  writer.put(facts.mean_luminances);
  return writer.take();
}

FilmFacts facts_from(const std::vector<uint8_t>& bytes) {
  ByteReader reader(bytes, "a film of another process");
  FilmFacts facts;
  for (const PassRange& range : reader.get_array<PassRange>()) facts.passes.add(range);
  facts.samples_per_pixel = reader.get<uint64_t>();
  facts.mean_luminances = reader.get<std::array<Fixed, replicate_count>>();
  reader.expect_end();
  return facts;
}

}  // namespace

void add_films(Team& team, Film& film) {
  const bool leads = team.is_led_here();
  // What the leader has is in its film already.
  const auto facts = team.to_leader(leads ? std::vector<uint8_t>() : bytes_of(film.facts()));
  const size_t tiles = film.tiles().count(), tile_sums = film.sums_per_tile();
  const size_t at_once = std::clamp<size_t>(most_bytes / (tile_sums * sizeof(Fixed)), 1, tiles);
  std::vector<Fixed> sums;
  for (size_t first = 0; first < tiles; first += at_once) {
    const size_t count = std::min(at_once, tiles - first);
    sums.assign(count * tile_sums, 0);
    if (!leads) film.read_tiles(first, sums);
    team.add_up(sums);
    if (leads) film.add_tiles(first, sums);
  }
  if (!leads) return film.clear();
  for (const std::vector<uint8_t>& of_member : facts)
    if (!of_member.empty()) film.add_facts(facts_from(of_member));
}

}  // namespace kaustik
