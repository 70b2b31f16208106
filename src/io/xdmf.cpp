// SPDX-License-Identifier: BSD-3-Clause
#include "io/xdmf.hpp"

#include <filesystem>
#include <iterator>

#include <fcntl.h>

#include <fmt/format.h>

#include "io/files.hpp"

namespace carrom {

namespace {

/// Rows of frame `frame` of a dataset with three numbers a disc.
std::string rows_of_frame(const std::string& file, const TrajectoryLayout& layout,
                          const char* element, std::size_t frame, std::size_t n_frames) {
    const std::uint64_t n = layout.n_discs;
    return fmt::format("<DataItem ItemType=\"HyperSlab\" Dimensions=\"{0} 3\"><DataItem "
                       "Dimensions=\"3 3\" Format=\"XML\">{1} 0 0 1 1 1 "
                       "1 {0} 3</DataItem><DataItem NumberType=\"Float\" Precision=\"{2}\" "
                       "Dimensions=\"{3} {0} 3\" Format=\"HDF\">"
                       "{4}:/particles/discs/{5}/value</DataItem></DataItem>",
                       n, frame, layout.is_single ? 4 : 8, n_frames, file, element);
}

/// The same of one with one number a disc.
std::string numbers_of_frame(const std::string& file, const TrajectoryLayout& layout,
                             const char* element, std::size_t frame, std::size_t n_frames) {
    return fmt::format("<DataItem ItemType=\"HyperSlab\" Dimensions=\"{0}\"><DataItem "
                       "Dimensions=\"3 2\" Format=\"XML\">{1} 0 1 1 "
                       "1 {0}</DataItem><DataItem NumberType=\"Float\" Precision=\"{2}\" "
                       "Dimensions=\"{3} {0}\" Format=\"HDF\">"
                       "{4}:/particles/discs/{5}/value</DataItem></DataItem>",
                       layout.n_discs, frame, layout.is_single ? 4 : 8, n_frames, file, element);
}

} // namespace

void write_xdmf(const std::string& path, const TrajectoryLayout& layout,
                std::span<const std::int64_t> steps) {
    if (!layout.has_position) return; // nothing to be seen
    const std::string file = std::filesystem::path(path).filename().string();
    std::string text = "<?xml version=\"1.0\"?>\n<Xdmf Version=\"2.0\"><Domain><Grid "
                       "Name=\"discs\" GridType=\"Collection\" "
                       "CollectionType=\"Temporal\">\n";
    for (std::size_t frame = 0; frame < steps.size(); ++frame) {
        fmt::format_to(std::back_inserter(text),
                       "<Grid Name=\"step {0}\"><Time Value=\"{0}\"/><Topology "
                       "TopologyType=\"Polyvertex\" NumberOfElements=\"{1}\"/>"
                       "<Geometry GeometryType=\"XYZ\">{2}</Geometry>",
                       steps[frame], layout.n_discs,
                       rows_of_frame(file, layout, "position", frame, steps.size()));
        if (layout.has_velocity)
            fmt::format_to(std::back_inserter(text),
                           "<Attribute Name=\"velocity\" AttributeType=\"Vector\" "
                           "Center=\"Node\">{}</Attribute>",
                           rows_of_frame(file, layout, "velocity", frame, steps.size()));
        if (layout.has_angular_velocity)
            fmt::format_to(std::back_inserter(text),
                           "<Attribute Name=\"angular_velocity\" AttributeType=\"Scalar\" "
                           "Center=\"Node\">{}</Attribute>",
                           numbers_of_frame(file, layout, "angular_velocity", frame, steps.size()));
        text += "</Grid>\n";
    }
    text += "</Grid></Domain></Xdmf>\n";
    const std::string target = std::filesystem::path(path).replace_extension(".xdmf").string(),
                      partial = target + ".partial";
    Descriptor(partial, O_WRONLY | O_CREAT | O_TRUNC).write(std::as_bytes(std::span(text)), 0);
    rename_durably(partial, target);
}

} // namespace carrom
