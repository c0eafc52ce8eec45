#pragma once
#include <cstdint>
#include <span>
#include <string>

namespace kaustik::app {

/// Opens what the program was started without, so that no file gets the number of a standard
/// stream; and lets writing to a closed pipe be an error of the write, not the program's end.
void prepare_standard_streams();

/// What is thrown where nobody reads standard output any more. That is no failure to tell of: the
/// program ends as others do, by end_by_broken_pipe(), once everything else is done.
struct ReaderGone {};

/// Throws Error(system) if something that was printed did not get through, ReaderGone if nobody
/// reads it.
void finish_standard_output();
/// Ends the program by SIGPIPE; returns only where that is blocked.
void end_by_broken_pipe();
/// Whether printing to it has failed.
bool standard_output_failed();

/// Whether a file's name means standard input or output: "-", or with a format "png:-".
bool is_standard_stream(const std::string& name);

/// All of standard input; throws Error(input) if it is too much for a scene.
std::string read_standard_input();
/// Throws Error(system) if it cannot be written, ReaderGone if nobody reads it.
void write_standard_output(std::span<const uint8_t> bytes);

}  // namespace kaustik::app
