// The fuzz targets. A target reads one input with the same functions as the programs. The only allowed outcomes are
// success and an InputError with a printable message. Everything else is a finding: another exception, a crash, a
// failed assertion of the target, a hang, or too much memory.
//
// fuzz_main.cpp makes a libFuzzer program of each target. replay_test.cpp reads all seeds without libFuzzer.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace stopline::fuzz {

class Random;

// Changes the text without knowledge of its structure (LLVMFuzzerMutate).
using ByteMutator = void (*)(std::string& text);

struct Target {
    std::string_view name;
    void (*run)(std::string_view input);
    // Changes an input and keeps most of its structure, so that the reader does not refuse it at once. Null: changes of
    // bytes are good enough.
    void (*mutate)(std::string& input, Random& random, ByteMutator mutate_bytes) = nullptr;
};

std::span<const Target> targets();
// Returns the target with this name. Aborts if there is none.
const Target& target(std::string_view name);
// Returns the folder that has a folder of seeds for each target.
std::filesystem::path seeds_folder();

// Each function runs one target.
void run_quantities(std::string_view input);
void run_formulas(std::string_view input);
void run_overrides(std::string_view input);
void run_scenario(std::string_view input);
void run_streets(std::string_view input);
void run_sweep(std::string_view input);
void run_sumo_net(std::string_view input);
void run_sumo_additional(std::string_view input);
void run_sumo_routes(std::string_view input);
void run_recording(std::string_view input);

}  // namespace stopline::fuzz
