#pragma once

#include <string>

#include <barchan/app/command_line.hpp>
#include <barchan/comm/communicator.hpp>

namespace barchan::app {

/// `barchan run`. Collective. Errors: InputError, the same on every rank; RunError.
void run_deck(const Communicator& world, const RunArguments& arguments);

/// `barchan check`, on one rank of however many. Errors: InputError.
void check_deck(const CheckArguments& arguments);

/// `barchan probe`: what every exchange costs between these ranks. Collective. Errors: InputError.
void probe(const Communicator& world, const ProbeArguments& arguments);

void show_info(const std::string& path);
void convert(const ConvertArguments& arguments);

/// `info` and `convert`, and `check`: what one process does alone.
void run_local(const CommandLine& line);
void run_local_on_root(const Communicator& world, const CommandLine& line);

}  // namespace barchan::app
