// SPDX-License-Identifier: BSD-3-Clause
#include "initial_state/scene_input.hpp"

#include <fstream>

#include "initial_state/initial_state.hpp"
#include "parallel/agreement.hpp"

namespace carrom {

namespace {

/// Replaces `columns` on every rank by rank 0's columns. **Collective.**
void broadcast(DiscColumns& columns, const Communicator& ranks) {
    ranks.broadcast(columns.species);
    for (std::vector<NumberRun>& runs : columns.numbers.values) ranks.broadcast(runs);
    int is_whole = columns.is_whole ? 1 : 0;
    ranks.broadcast(is_whole);
    columns.is_whole = is_whole == 1;
}

} // namespace

void broadcast(SceneText& text, const Communicator& ranks) {
    ranks.broadcast(text.name);
    ranks.broadcast(text.text);
    ranks.broadcast(text.lines_before_discs);
    int discs_follow = text.discs_follow ? 1 : 0;
    ranks.broadcast(discs_follow);
    text.discs_follow = discs_follow == 1;
}

DiscColumns load_columns(const SceneParameters& scene, std::istream* following,
                         const Communicator& ranks) {
    DiscColumns columns;
    columns.is_whole = false;
    if (ranks.is_root()) {
        try {
            std::ifstream file;
            if (scene.discs_file.empty()) {
                const auto begin = following->tellg();
                columns = read_disc_columns(*following, scene);
                following->clear();
                following->seekg(begin);
            } else {
                file = open_input(discs_path(scene));
                columns = read_disc_columns(file, scene);
            }
        } catch (const InputError&) { // the reader of lines reports this error with all others
        }
    }
    broadcast(columns, ranks);
    return columns;
}

std::vector<InputDisc> load_places(const SceneParameters& scene, std::istream* following,
                                   const Communicator& ranks, int n_threads) {
    if (!scene.reads_disc_lines() || scene.discs_file.empty())
        return initial_places(scene, scene.reads_disc_lines() ? following : nullptr, ranks,
                              n_threads);
    std::ifstream file;
    let_root(ranks, [&] { file = open_input(discs_path(scene)); });
    return initial_places(scene, &file, ranks, n_threads);
}

} // namespace carrom
