#include "host/axistool/program.hpp"

int main(int argc, char** argv) { return axistool::run_program(argc, argv); }
