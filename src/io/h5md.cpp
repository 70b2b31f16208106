// SPDX-License-Identifier: BSD-3-Clause
#include "io/h5md.hpp"

#include <array>

namespace carrom::h5md {

void write_metadata(hid_t file, const std::string& program_version) {
    const h5::Group h5md = h5::create_group(file, "h5md");
    h5::write_attribute(h5md.id(), "version", std::array<std::int32_t, 2>{1, 1});
    h5::write_attribute(h5::create_group(h5md.id(), "author").id(), "name", std::string("carrom"));
    const h5::Group creator = h5::create_group(h5md.id(), "creator");
    h5::write_attribute(creator.id(), "name", std::string("carrom"));
    h5::write_attribute(creator.id(), "version", program_version);
}

h5::Group create_box(hid_t parent, bool is_periodic_x, bool is_periodic_y) {
    h5::Group box = h5::create_group(parent, "box");
    h5::write_attribute(box.id(), "dimension", std::array<std::int32_t, 1>{3});
    const auto boundary = [](bool is_periodic) -> std::string {
        return is_periodic ? "periodic" : "none";
    };
    h5::write_attribute(
        box.id(), "boundary",
        std::vector<std::string>{boundary(is_periodic_x), boundary(is_periodic_y), "none"});
    return box;
}

} // namespace carrom::h5md
