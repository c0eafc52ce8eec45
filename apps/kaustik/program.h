#pragma once

namespace kaustik::app {

/// The command line program; returns its exit code. Once.
int run_program(int argc, char** argv);

}  // namespace kaustik::app
