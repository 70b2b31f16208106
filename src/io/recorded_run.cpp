// SPDX-License-Identifier: BSD-3-Clause
#include "io/recorded_run.hpp"

#include <string_view>

#include "io/checkpoint_fields.hpp"
#include "io/files.hpp"

namespace carrom {

namespace {

constexpr const char* scene_path = "/carrom/scene";

bool is_recorded(const HeaderField& entry) {
    return std::string_view(entry.name).starts_with("scene_") ||
           std::string_view(entry.name) == "n_discs";
}

} // namespace

void write_recorded_run(hid_t file, const CheckpointHeader& run) {
    if (run.scene_text.empty()) return;
    const h5::Group scene = h5::create_group(file, scene_path);
    for (const HeaderField& entry : checkpoint_header)
        if (is_recorded(entry))
            std::visit([&](auto field) { h5::write_scalar(scene.id(), entry.name, run.*field); },
                       entry.field);
    write_species(file, species_path, run.species);
}

void check_recorded_run(hid_t file, const DifferenceFrom& difference_from) {
    if (!difference_from || !h5::has(file, scene_path)) return;
    const h5::Group scene(h5::checked(H5Gopen2(file, scene_path, H5P_DEFAULT), scene_path));
    CheckpointHeader there;
    for (const HeaderField& entry : checkpoint_header)
        if (is_recorded(entry))
            std::visit([&](auto field) { h5::read_scalar(scene.id(), entry.name, there.*field); },
                       entry.field);
    there.species = read_species(file, species_path, there.n_discs);
    if (const std::string difference = difference_from(there); !difference.empty())
        throw FileError("is another run's (" + difference +
                        "); name another file, or move it away");
}

} // namespace carrom
