// SPDX-License-Identifier: BSD-3-Clause
#include "initial_state/listed_discs.hpp"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <system_error>

#include "core/errors.hpp"
#include "core/plain_file.hpp"
#include "parallel/agreement.hpp"
#include "parallel/exchange.hpp"
#include "scene/disc_reader.hpp"

namespace carrom {

namespace {

DiscReader::InParts on_threads(int n_threads) {
    return [n_threads](std::size_t n, const auto& work) {
        const auto n_parts = static_cast<std::size_t>(n_threads);
#pragma omp parallel for num_threads(n_threads) schedule(static)
        for (std::size_t k = 0; k < n_parts; ++k) work(n * k / n_parts, n * (k + 1) / n_parts);
    };
}

/// Size in bytes of the scene's file of discs, which rank 0 finds. It is 0 if the file is missing
/// or is a pipe, because ranks then cannot read parts of it. **Collective.**
std::uint64_t bytes_of_file(const SceneParameters& scene, const Communicator& communicator) {
    std::uint64_t n_bytes = 0;
    if (communicator.is_root()) {
        std::error_code error;
        const std::filesystem::path path = discs_path(scene);
        if (std::filesystem::is_regular_file(path, error))
            n_bytes = std::filesystem::file_size(path, error);
        if (error) n_bytes = 0;
    }
    communicator.broadcast(n_bytes);
    return n_bytes;
}

/// Moves `file` to the first line of the rank's part. A line belongs to the part in which it
/// begins, so the rest of a line from the previous part is skipped.
DiscReader::Part go_to_part(std::istream& file, std::uint64_t n_bytes,
                            const Communicator& communicator) {
    const auto [begin, end] = slab_of_rank(communicator.rank(), n_bytes, communicator.size());
    if (begin == 0) return {true, end};
    file.seekg(static_cast<std::streamoff>(begin - 1));
    file.ignore(static_cast<std::streamsize>(end - begin + 1), '\n');
    return {false, end - begin + 1 - static_cast<std::uint64_t>(file.gcount())};
}

bool is_each_once(const std::vector<InputDisc>& discs, const Slab& share) {
    std::vector<bool> seen(share.size());
    for (const InputDisc& disc : discs)
        if (disc.id >= share.begin && disc.id < share.end) seen[disc.id - share.begin] = true;
    return discs.size() == share.size() && std::ranges::find(seen, false) == seen.end();
}

/// Each rank reads its part of the file. Returns nothing if the file has an error, or if not all
/// ranks can read it. **Collective.**
std::optional<std::vector<InputDisc>> read_on_all(const SceneParameters& scene,
                                                  const Communicator& communicator, int n_threads) {
    const std::uint64_t n_bytes = bytes_of_file(scene, communicator);
    if (n_bytes == 0) return std::nullopt;
    std::ifstream file = open_plain_file(discs_path(scene));
    if (communicator.any(!file)) return std::nullopt;
    DiscReader reader(file, scene, go_to_part(file, n_bytes, communicator));
    const Slab share = share_of(scene, communicator);
    std::vector<InputDisc> discs, chunk;
    discs.reserve(share.size());
    // Number of ranks that may have more lines, and number of ranks that have found an error
    std::uint64_t n_ranks[2] = {};
    do {
        const bool has_more = reader.read(chunk, discs_at_once, on_threads(n_threads));
        hand_out(chunk, scene, communicator, discs);
        const bool is_sound = reader.is_flawless() && discs.size() <= share.size();
        n_ranks[0] = has_more ? 1 : 0;
        n_ranks[1] = is_sound ? 0 : 1;
        communicator.sum(n_ranks);
    } while (n_ranks[0] > 0 && n_ranks[1] == 0);
    if (n_ranks[1] > 0 || communicator.any(!is_each_once(discs, share))) return std::nullopt;
    return discs;
}

/// Reads the lines of `discs.from`. Each rank reads its share; rank 0's stream also contains the
/// shares of all other ranks. Returns nothing if a line has an error, or if some rank cannot read
/// the file; rank 0's stream is then back at its first line. **Collective.**
std::optional<std::vector<InputDisc>> read_shares(const SceneParameters& scene, std::istream* lines,
                                                  const Communicator& communicator, int n_threads) {
    if (communicator.any(lines == nullptr)) return std::nullopt;
    const Slab share = share_of(scene, communicator);
    DiscReader reader(*lines, scene, {communicator.is_root(), LineReader::no_limit});
    std::vector<InputDisc> discs, chunk;
    discs.reserve(share.size());
    while (discs.size() < share.size() &&
           reader.read(chunk, std::min<std::size_t>(discs_at_once, share.size() - discs.size()),
                       on_threads(n_threads)))
        discs.insert(discs.end(), chunk.begin(), chunk.end());
    const bool is_sound = reader.is_flawless() && is_each_once(discs, share);
    if (!communicator.any(!is_sound)) return discs;
    if (communicator.is_root()) {
        lines->clear();
        lines->seekg(0);
    }
    return std::nullopt;
}

/// Reads all lines on rank 0, which sends the discs to their ranks. **Collective.**
std::vector<InputDisc> read_on_root(const SceneParameters& scene, std::istream* lines,
                                    const Communicator& communicator, int n_threads) {
    std::vector<InputDisc> discs, chunk;
    std::vector<Problem> problems;
    if (communicator.is_root()) {
        ensure(lines != nullptr, "listed discs need a stream on rank 0");
        DiscReader reader(*lines, scene);
        for (bool has_more = true; has_more;) {
            has_more = reader.read(chunk, discs_at_once, on_threads(n_threads));
            if (!communicator.any(has_more)) break;
            hand_out(chunk, scene, communicator, discs);
        }
        problems = reader.problems();
    } else {
        while (communicator.any(false)) hand_out(chunk, scene, communicator, discs);
    }
    agree_on_problems(communicator, problems);
    return discs;
}

} // namespace

void hand_out(const std::vector<InputDisc>& chunk, const SceneParameters& scene,
              const Communicator& communicator, std::vector<InputDisc>& discs) {
    std::vector<std::vector<InputDisc>> out(static_cast<std::size_t>(communicator.size()));
    for (const InputDisc& disc : chunk)
        out[static_cast<std::size_t>(slab_of(disc.id, scene.n_discs, communicator.size()))]
            .push_back(disc);
    const Received<InputDisc> in = send_to_owners(communicator, out);
    discs.insert(discs.end(), in.items.begin(), in.items.end());
}

std::vector<InputDisc> read_listed_discs(const SceneParameters& scene, std::istream* lines,
                                         const Communicator& communicator, int n_threads) {
    std::optional<std::vector<InputDisc>> discs;
    if (communicator.size() > 1 && !scene.discs_file.empty())
        discs = read_on_all(scene, communicator, n_threads);
    else if (communicator.size() > 1 && !scene.discs_from.empty())
        discs = read_shares(scene, lines, communicator, n_threads);
    if (discs) return std::move(*discs);
    return read_on_root(scene, lines, communicator, n_threads);
}

} // namespace carrom
