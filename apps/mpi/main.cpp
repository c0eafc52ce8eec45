// mpirun kaustik-mpi render …: the passes of one picture by all processes that mpirun has started.

#include <fmt/format.h>
#include <mpi.h>

#include <cstdio>
#include <memory>
#include <string_view>

#include "exit_codes.h"
#include "mpi_team.h"
#include "program.h"
#include "render_team.h"

namespace {

using namespace kaustik::app;

/// Other commands would do the same in each process.
bool is_for_all(int argc, char** argv) {
  if (argc < 2) return true;
  const std::string_view command = argv[1];
  return command == "render" || command.starts_with('-');
}

int run(int argc, char** argv) {
  const auto team = std::make_shared<MpiTeam>();
  join_team(team);
  if (is_for_all(argc, argv)) return team->is_led_here() || argc > 2 ? run_program(argc, argv) : 0;
  if (team->is_led_here())
    std::fputs(fmt::format("error: kaustik-mpi renders, and does nothing else\n"
                           "  remedy: kaustik {} …, without mpirun\n",
                           argv[1])
                   .c_str(),
               stderr);
  return exit_input;
}

}  // namespace

int main(int argc, char** argv) {
  // All calls come from the thread that renders.
  int provided = 0;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_SERIALIZED, &provided);
  const int exit_code = run(argc, argv);
  // Others may wait for one that has failed, and for ever.
  if (exit_code != 0 && exit_code != exit_ended_early) MPI_Abort(MPI_COMM_WORLD, exit_code);
  const bool was_follower = is_follower();
  join_team(nullptr);
  MPI_Finalize();
  // mpirun ends the others as soon as one tells that not all was done.
  return was_follower ? 0 : exit_code;
}
