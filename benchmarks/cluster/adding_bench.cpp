// How long processes of MPI take to add up their films, whatever network is between them. The
// leader prints a line of JSON: seconds, the bytes of a film's sums, and the processes.
//
// `mpirun … adding_bench WIDTH HEIGHT`
#include <fmt/format.h>
#include <mpi.h>

#include <cstdlib>
#include <random>

#include "apps/mpi/mpi_team.h"
#include "benchmarks/report.h"
#include "kaustik/render/film_reduction.h"

namespace {

using namespace kaustik;

Film noisy_film(const Vec2i& size, uint32_t pass) {
  FilmSettings settings;
  settings.size = settings.crop_size = size;
  Film film(settings, {ComponentSet::all()});
  PassTiles tiles(size);
  std::mt19937 generator(pass);
  std::exponential_distribution<float> light(3);
  const auto pixels = std::make_unique<PassTiles::Pixels>();
  for (size_t tile = 0; tile < tiles.tiles().count(); ++tile) {
    for (PassPixel& pixel : *pixels)
      for (auto& radiance : pixel.radiance)
        radiance = {light(generator), light(generator), light(generator), 0};
    tiles.store(tile, *pixels);
  }
  film.add_pass(tiles, pass, 1);
  return film;
}

void measure(const Vec2i& size) {
  app::MpiTeam team;
  Film film = noisy_film(size, team.rank());
  // All begin together.
  team.from_leader(std::vector<uint8_t>(1));
  team.to_leader({});
  team.from_leader({});
  const double seconds = bench::seconds_of([&] { add_films(team, film); });
  if (team.is_led_here())
    fmt::print("{{\"seconds\": {}, \"bytes\": {}, \"processes\": {}}}\n", seconds,
               film.tiles().count() * film.sums_per_tile() * sizeof(Fixed), team.size());
}

}  // namespace

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  measure({argc > 2 ? std::atoi(argv[1]) : 1920, argc > 2 ? std::atoi(argv[2]) : 1080});
  MPI_Finalize();
}
