// SPDX-License-Identifier: BSD-3-Clause
// libFuzzer on the reader of checkpoints. It replaces bytes of an undamaged file, because random
// bytes would fail at the checksums.
//
// Input: a first byte, then edits of at least 4 bytes: a place among the non-empty bytes of the
// file (3 bytes), a length or a kind of edit (1), the new bytes. An odd first byte means forgery:
// only values of the header and of the discs change, and the checksums are corrected, so that HDF5
// and the reader's own checks are reached. (damaged_files.cpp forges metadata.) Every file must
// give a valid checkpoint or an error of code 2. A changed file that is not forged must give an
// error. docs/understanding/hard-cases.md has the commands.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <unistd.h>

#include "core/errors.hpp"
#include "core/state_hash.hpp"
#include "io/checkpoint.hpp"
#include "io/checkpoint_fields.hpp"
#include "io/hdf5.hpp"
#include "io/start_io.hpp"
#include "parallel/mpi.hpp"
#include "sample_files.hpp"

using namespace carrom;

namespace {

constexpr std::uint8_t cut_short = 255;
constexpr std::size_t most_replaced = 16;

void demand(bool claim) {
    if (!claim) std::abort();
}

std::string path() { return "/dev/shm/carrom_fuzzed_" + std::to_string(::getpid()) + ".h5"; }

std::vector<char> whole_checkpoint(const Communicator& world) {
    test::write_sample_checkpoint(path(), world);
    return test::bytes_of(path());
}

/// The places of non-empty bytes, because most of a small file is empty space between its data
/// sets.
std::vector<std::size_t> places_in(const std::vector<char>& bytes) {
    constexpr std::size_t margin = 8;
    std::vector<std::size_t> places;
    std::size_t from = 0;
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        if (bytes[i] == 0) continue;
        for (from = std::max(from, i > margin ? i - margin : 0);
             from < std::min(i + margin, bytes.size()); ++from)
            places.push_back(from);
    }
    return places;
}

/// The places of the values of the header and of the discs.
std::vector<std::size_t> places_of_values() {
    std::vector<std::size_t> places;
    const h5::File file = h5::open_file(path(), h5::Access::read);
    const auto add = [&](const std::string& name) {
        const h5::Dataset dataset = h5::open_dataset(file.id(), name);
        const haddr_t begin = H5Dget_offset(dataset.id());
        demand(begin != HADDR_UNDEF);
        for (hsize_t k = 0; k < H5Dget_storage_size(dataset.id()); ++k) places.push_back(begin + k);
    };
    const CheckpointHeader header;
    visit_header(header,
                 [&](const char* name, const auto&) { add(std::string("/carrom/run/") + name); });
    for (const StateColumn& column : disc_columns) add(std::string("/carrom/discs/") + column.name);
    add(path_of(SideColumn::spin));
    return places;
}

/// The file with the edits of the input.
std::vector<char> edited(std::vector<char> bytes, const std::vector<std::size_t>& places,
                         std::span<const std::uint8_t> input, bool may_be_cut) {
    while (input.size() >= 4) {
        const std::size_t place =
            places[(input[0] | std::size_t{input[1]} << 8 | std::size_t{input[2]} << 16) %
                   places.size()];
        const std::uint8_t what = input[3];
        input = input.subspan(4);
        if (place >= bytes.size()) continue; // beyond the end of a file that was cut
        if (what == cut_short && may_be_cut) {
            bytes.resize(place);
            continue;
        }
        const std::size_t n = std::min(
            {what % most_replaced + 1, input.size(), bytes.size() - place});
        std::copy_n(input.begin(), n, bytes.begin() + static_cast<std::ptrdiff_t>(place));
        input = input.subspan(n);
    }
    return bytes;
}

void check(const Checkpoint& checkpoint) {
    const CheckpointHeader& header = checkpoint.header;
    demand(header.n_discs == checkpoint.discs.size() && header.n_discs > 0);
    demand(header.micro_steps >= 1 && header.sync_every >= 1 &&
           header.micro_steps_done == header.step * header.micro_steps);
    demand(checkpoint.columns.present() == header.columns);
    StateHash hash = hash_of(checkpoint.discs);
    const std::vector<double>& spins = checkpoint.columns[SideColumn::spin];
    for (std::size_t i = 0; i < spins.size(); ++i) hash += hash_of(SideColumn::spin, i, spins[i]);
    demand(to_string(hash) == header.state_hash);
    for (std::size_t i = 0; i < checkpoint.discs.size(); ++i) demand(checkpoint.discs[i].id == i);
}

struct Ground {
    Mpi mpi;
    Communicator world = Communicator::world();
    std::vector<char> whole = whole_checkpoint(world);
    test::Forger forger{path()};
    std::vector<std::size_t> places = places_in(whole), places_of_values = ::places_of_values();

    Ground(int& argc, char**& argv) : mpi(argc, argv) {
        demand(whole[places_of_values.front()] ==
               // the first value is the version 0.x, so this tests that the places are correct
               '0');
    }
};

std::optional<Ground> ground;

} // namespace

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
    start_io();
    ground.emplace(*argc, *argv);
    std::atexit([] {
        ::unlink(path().c_str());
        ground.reset();
    });
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) return 0;
    const bool is_forged = data[0] % 2 == 1;
    const std::vector<char> bytes = edited(ground->whole,
                                           is_forged ? ground->places_of_values : ground->places,
                                           std::span(data, size).subspan(1), !is_forged);
    if (is_forged)
        ground->forger.write(path(), bytes);
    else
        test::write_bytes(path(), bytes);
    try {
        check(read_checkpoint(path(), ground->world));
        demand(is_forged || bytes == ground->whole);
    } catch (const CollectiveError& error) {
        demand(error.code() == ExitCode::bad_input);
    }
    return 0;
}
