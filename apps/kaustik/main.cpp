#include "program.h"

int main(int argc, char** argv) { return kaustik::app::run_program(argc, argv); }
