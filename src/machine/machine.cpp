// SPDX-License-Identifier: BSD-3-Clause
#include "machine/machine.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <climits>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <latch>
#include <limits>
#include <string_view>
#include <system_error>
#include <vector>

#include <omp.h>
#include <pthread.h>
#include <sched.h>
#include <sys/resource.h>
#include <unistd.h>

#include <hwy/targets.h>

#include "core/useful_threads.hpp"
#include "parallel/agreement.hpp"

namespace carrom {

namespace {

constexpr int most_threads = 1024;
/// The largest number of threads per core that gives no warning. Two are usual in trials on small
/// machines.
constexpr int most_crowded = 2;
/// Up to two threads give no warning, however few discs a rank has.
constexpr int few_threads = 2;

/// The variable OMP_NUM_THREADS. An empty value counts as unset, because a batch script may set it
/// from a variable that does not exist.
std::string thread_variable() {
    const char* text = std::getenv("OMP_NUM_THREADS");
    return text == nullptr ? "" : text;
}

/// OMP_NUM_THREADS may be a list for nested regions; the first number is for the outermost region.
/// Returns 0 if it is not a number.
int threads_from_environment() {
    const std::string text = thread_variable();
    int threads = 0;
    const char* const first = text.data() + std::min(text.find_first_not_of(" \t"), text.size());
    const char* const end = std::from_chars(first, text.data() + text.size(), threads).ptr;
    const bool is_number = end == text.data() + text.size() || *end == ',' || *end == ' ';
    return is_number && threads > 0 && threads <= most_threads ? threads : 0;
}

std::string host_name() {
    std::string name(256, '\0');
    gethostname(name.data(), name.size() - 1);
    return name;
}

/// The number of ranks that have the same key as this rank. **Collective.**
int sharers_of(std::uint64_t key, const Communicator& ranks) {
    std::vector<std::uint64_t> keys(static_cast<std::size_t>(ranks.size()), 0);
    keys[static_cast<std::size_t>(ranks.rank())] = key;
    ranks.sum(keys); // each rank adds its own key and zeros, so the sum has all keys
    return static_cast<int>(std::count(keys.begin(), keys.end(), key));
}

constexpr std::uint64_t without_limit = std::numeric_limits<std::uint64_t>::max();

/// The memory of the node in bytes, including swap.
std::uint64_t memory_of_node() {
    std::ifstream facts("/proc/meminfo");
    std::uint64_t sum = 0;
    for (std::string line; std::getline(facts, line);)
        if (line.starts_with("MemTotal:") || line.starts_with("SwapTotal:"))
            sum += std::strtoull(line.c_str() + line.find(':') + 1, nullptr, 10) * 1024;
    return sum > 0 ? sum : without_limit;
}

/// The smallest memory limit, in bytes, of this process's control group (version 2, or `memory` of
/// version 1) and of the groups that contain it.
std::uint64_t memory_of_control_group() {
    std::uint64_t least = without_limit;
    const auto read_limit = [&least](const std::filesystem::path& path) {
        std::ifstream file(path);
        if (std::uint64_t bytes = 0; file >> bytes)
            least = std::min(least, bytes); // "max" means no limit and is not a number
    };
    std::ifstream groups("/proc/self/cgroup");
    for (std::string line; std::getline(groups, line);) {
        const bool is_second = line.starts_with("0::");
        if (!is_second && line.find(":memory:") == std::string::npos) continue;
        const std::filesystem::path root = is_second ? "/sys/fs/cgroup" : "/sys/fs/cgroup/memory";
        std::filesystem::path group = line.substr(line.rfind(':') + 1);
        for (;; group = group.parent_path()) {
            read_limit(root / group.relative_path() /
                       (is_second ? "memory.max" : "memory.limit_in_bytes"));
            if (!group.has_relative_path()) break;
        }
    }
    return least;
}

/// The stack size in bytes of each OpenMP thread, if the environment sets a usable one; else 0. The
/// variable is a number with the unit B, K, M or G (powers of 1024); without a unit it is K.
std::size_t stack_of_threads() {
    for (const char* name : {"OMP_STACKSIZE", "GOMP_STACKSIZE"}) {
        const char* const text = std::getenv(name);
        if (text == nullptr) continue;
        char* end = nullptr;
        const double number = std::strtod(text, &end);
        const std::size_t unit = std::string_view("bBkKmMgG").find(*end);
        const int power = *end == '\0' || unit == std::string_view::npos
                              ? 1
                              : static_cast<int>(unit / 2);
        const double bytes = std::ldexp(number, 10 * power);
        return bytes >= static_cast<double>(PTHREAD_STACK_MIN) && bytes < 0x1p62
                   ? static_cast<std::size_t>(bytes)
                   : 0;
    }
    return 0;
}

/// Threads that wait until all of them have started, or until one has failed to start.
class WaitingThreads {
public:
    /// `stack` is the size of each thread's stack in bytes, or 0 for the system's default.
    WaitingThreads(int n, std::size_t stack) {
        pthread_attr_t attributes;
        pthread_attr_init(&attributes);
        if (stack > 0) pthread_attr_setstacksize(&attributes, stack);
        const auto wait = [](void* latch) -> void* {
            static_cast<std::latch*>(latch)->wait();
            return nullptr;
        };
        for (pthread_t thread{}; count() < n;) {
            if (pthread_create(&thread, &attributes, wait, &may_end_) != 0) break;
            threads_.push_back(thread);
        }
        pthread_attr_destroy(&attributes);
    }
    ~WaitingThreads() {
        may_end_.count_down();
        for (const pthread_t thread : threads_) pthread_join(thread, nullptr);
    }
    WaitingThreads(const WaitingThreads&) = delete;
    WaitingThreads& operator=(const WaitingThreads&) = delete;

    int count() const { return static_cast<int>(threads_.size()); }

private:
    std::latch may_end_{1};
    std::vector<pthread_t> threads_;
};

struct AllowedCores {
    int count = 1;
    std::uint64_t key = 0; ///< equal on ranks of a node that may use the same cores
};

AllowedCores allowed_cores() {
    std::array<cpu_set_t, 8> mask{}; // room for 8192 cores
    AllowedCores cores;
    if (sched_getaffinity(0, sizeof mask, mask.data()) == 0)
        cores.count = std::max(1, CPU_COUNT_S(sizeof mask, mask.data()));
    std::string identity = host_name();
    identity.append(reinterpret_cast<const char*>(mask.data()), sizeof mask);
    cores.key = std::hash<std::string>{}(identity);
    return cores;
}

} // namespace

std::string version() { return CARROM_VERSION; }

BuildFacts build_facts() { return {CARROM_COMPILER, CARROM_FLAGS, CARROM_COMMIT}; }

std::string vector_target() {
    const auto usable = static_cast<std::uint64_t>(hwy::SupportedTargets() & HWY_TARGETS);
    const std::uint64_t best = usable & (~usable + 1); // the lowest bit is the best target
    return hwy::TargetName(static_cast<std::int64_t>(best));
}

std::string processor_name() {
    std::ifstream facts("/proc/cpuinfo");
    for (std::string line; std::getline(facts, line);) {
        const std::size_t colon = line.find(": ");
        if (line.starts_with("model name") && colon != std::string::npos)
            return line.substr(colon + 2);
    }
    return {};
}

int default_threads(const Communicator& ranks) {
    const AllowedCores mine = allowed_cores();
    const int sharers = sharers_of(mine.key, ranks);
    const int asked = threads_from_environment();
    return asked > 0 ? asked : std::max(1, mine.count / sharers);
}

void check_threads(int threads, const Communicator& ranks) {
    std::string failure;
    const std::size_t stack = stack_of_threads();
    if (const int started = 1 + WaitingThreads(threads - 1, stack).count(); started < threads)
        failure = "rank " + std::to_string(ranks.rank()) + " can start " + std::to_string(started) +
                  " of its " + std::to_string(threads) + " threads only" +
                  (stack > 0 ? ", with stacks of " + std::to_string(stack) +
                                   " bytes (OMP_STACKSIZE, take less)"
                             : std::string{}) +
                  "; take fewer by --threads, or raise the limits of threads and memory "
                  "(ulimit -u, ulimit -v)";
    agree(ranks, failure.empty(), failure);
}

std::string limit_in_the_way() {
    constexpr rlim_t least_memory = 128 << 20; // address space; Open MPI and 2 threads use 105 MiB
    constexpr rlim_t least_files = 24;         // Open MPI and a run without a folder open 17 files
    const auto limit_of = [](auto kind) {
        rlimit limit{};
        return getrlimit(kind, &limit) == 0 ? limit.rlim_cur : RLIM_INFINITY;
    };
    if (const rlim_t bytes = limit_of(RLIMIT_AS); bytes < least_memory)
        return "this process may have only " + std::to_string(bytes >> 10) +
               " KiB of memory, and MPI and threads take " + std::to_string(least_memory >> 10) +
               ": raise that limit (ulimit -v unlimited), then try again";
    if (const rlim_t files = limit_of(RLIMIT_NOFILE); files < least_files)
        return "this process may have only " + std::to_string(files) +
               " files open at once, and MPI takes " + std::to_string(least_files) +
               ": raise that limit (ulimit -n 1024), then try again";
    return {};
}

std::string warning_of_crowded_threads(int threads, std::uint64_t n_discs,
                                       const Communicator& ranks) {
    // If threads are bound to cores, only OpenMP reports how many cores all of them may use.
    const int cores = std::max(1, omp_get_num_procs());
    const int sharers = sharers_of(allowed_cores().key, ranks);
    const std::uint64_t own = n_discs / static_cast<std::uint64_t>(ranks.size());
    const int useful = std::max(few_threads, useful_threads(most_threads, own));
    const int best = std::min(std::max(1, cores / sharers), useful);
    const std::string advice = "; try: --threads " + std::to_string(best);
    if (threads > cores || (threads > best && threads * sharers > most_crowded * cores))
        return std::to_string(threads) + " threads" +
               (sharers > 1 ? " of each of " + std::to_string(sharers) + " ranks" : std::string{}) +
               " share " + std::to_string(cores) + (cores == 1 ? " core" : " cores") +
               ", and wait for each other" + advice;
    if (threads > useful)
        return std::to_string(threads) + " threads share the " + std::to_string(own) +
               " discs of a rank, and wait for each other longer than they work" + advice;
    return {};
}

std::string warning_of_thread_variable() {
    const std::string text = thread_variable();
    if (text.empty() || threads_from_environment() > 0) return {};
    return "OMP_NUM_THREADS = '" + text + "' is not a number of threads from 1 to " +
           std::to_string(most_threads) + " and is not heeded";
}

std::uint64_t memory_per_rank(const Communicator& ranks) {
    const auto sharers = static_cast<std::uint64_t>(
        sharers_of(std::hash<std::string>{}(host_name()), ranks));
    rlimit limit{};
    const bool is_limited = getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY;
    return std::min(std::min(memory_of_node(), memory_of_control_group()) / sharers,
                    is_limited ? std::uint64_t{limit.rlim_cur} : without_limit);
}

std::uint64_t peak_resident_bytes() {
    // Does not use getrusage, because its ru_maxrss survives
    // exec and may be the memory of a large parent process.
    std::ifstream status("/proc/self/status");
    constexpr std::string_view label = "VmHWM:";
    for (std::string line; std::getline(status, line);)
        if (line.starts_with(label))
            return std::strtoull(line.c_str() + label.size(), nullptr, 10) * 1024;
    return 0;
}

} // namespace carrom
