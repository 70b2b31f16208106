// SPDX-License-Identifier: BSD-3-Clause
#include "machine.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <functional>
#include <string_view>
#include <vector>

#include <sched.h>
#include <unistd.h>

namespace carrom {

namespace {

/// OMP_NUM_THREADS may be a list for nested regions; the first number is for the outermost. 0 where unset or not a number.
int threads_from_environment() {
    const char* text = std::getenv("OMP_NUM_THREADS");
    if (text == nullptr) return 0;
    int threads = 0;
    std::from_chars(text, text + std::strlen(text), threads);
    return std::max(threads, 0);
}

struct AllowedCores {
    int count = 1;
    std::uint64_t key = 0; ///< equal on two ranks that may use the very same cores of the very same node
};

AllowedCores allowed_cores() {
    std::array<cpu_set_t, 8> mask{}; // room for 8192 cores
    AllowedCores cores;
    if (sched_getaffinity(0, sizeof mask, mask.data()) == 0) cores.count = std::max(1, CPU_COUNT_S(sizeof mask, mask.data()));
    std::string identity(256, '\0');
    gethostname(identity.data(), identity.size() - 1);
    identity.append(reinterpret_cast<const char*>(mask.data()), sizeof mask);
    cores.key = std::hash<std::string>{}(identity);
    return cores;
}

} // namespace

std::string version() { return CARROM_VERSION; }

BuildFacts build_facts() { return {CARROM_COMPILER, CARROM_FLAGS}; }

std::string processor_name() {
    std::ifstream facts("/proc/cpuinfo");
    for (std::string line; std::getline(facts, line);) {
        const std::size_t colon = line.find(": ");
        if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
    }
    return {};
}

int default_threads(const Communicator& ranks) {
    const AllowedCores mine = allowed_cores();
    std::vector<std::uint64_t> keys(static_cast<std::size_t>(ranks.size()), 0);
    keys[static_cast<std::size_t>(ranks.rank())] = mine.key;
    ranks.sum(keys); // a sum of one number and zeros: every rank sees every key
    const auto sharers = static_cast<int>(std::count(keys.begin(), keys.end(), mine.key));
    const int asked = threads_from_environment();
    return asked > 0 ? asked : std::max(1, mine.count / sharers);
}

std::uint64_t peak_resident_bytes() {
    // Not getrusage: its ru_maxrss survives exec and may be that of a large parent process.
    std::ifstream status("/proc/self/status");
    constexpr std::string_view label = "VmHWM:";
    for (std::string line; std::getline(status, line);)
        if (line.starts_with(label)) return std::strtoull(line.c_str() + label.size(), nullptr, 10) * 1024;
    return 0;
}

} // namespace carrom
