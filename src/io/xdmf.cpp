// SPDX-License-Identifier: BSD-3-Clause
#include "io/xdmf.hpp"

#include <filesystem>
#include <iterator>

#include <fmt/format.h>

#include "io/files.hpp"

namespace carrom {

namespace {

/// Where a frame is stored: one row of a segment.
struct Row {
    const FileSegment& segment;
    std::uint64_t number;
};

/// The XDMF text of a field with three numbers, or one number, for each disc.
std::string numbers(const Row& row, const TrajectoryLayout& layout, const char* element,
                    bool are_vectors) {
    return fmt::format("<DataItem ItemType=\"HyperSlab\" Dimensions=\"{0}{6}\"><DataItem "
                       "Dimensions=\"3 {7}\" Format=\"XML\">{1} 0{8} 1 1{9} "
                       "1 {0}{6}</DataItem><DataItem NumberType=\"Float\" Precision=\"{2}\" "
                       "Dimensions=\"{3} {0}{6}\" Format=\"HDF\">"
                       "{4}:/particles/discs/{5}/value</DataItem></DataItem>",
                       layout.system.n_discs, row.number, layout.is_single ? 4 : 8,
                       row.segment.room, row.segment.name, element, are_vectors ? " 3" : "",
                       are_vectors ? 3 : 2, are_vectors ? " 0" : "", are_vectors ? " 1" : "");
}

std::string attribute(const char* name, const char* kind, const std::string& item) {
    return fmt::format("<Attribute Name=\"{}\" AttributeType=\"{}\" Center=\"Node\">{}</Attribute>",
                       name, kind, item);
}

/// The XDMF text of a number of each disc that is equal in all frames: radius or species.
std::string fixed(const std::string& file, const TrajectoryLayout& layout, const char* name,
                  const char* type) {
    return attribute(name, "Scalar",
                     fmt::format("<DataItem NumberType=\"{}\" Precision=\"8\" Dimensions=\"{}\" "
                                 "Format=\"HDF\">{}:/particles/discs/{}</DataItem>",
                                 type, layout.system.n_discs, file, name));
}

} // namespace

void write_xdmf(const std::string& path, const TrajectoryLayout& layout,
                std::span<const FileSegment> segments, std::span<const std::int64_t> steps) {
    if (!layout.has_position) return; // viewers need positions
    const std::string file = std::filesystem::path(path).filename().string();
    std::string text = "<?xml version=\"1.0\"?>\n<Xdmf Version=\"2.0\"><Domain><Grid "
                       "Name=\"discs\" GridType=\"Collection\" "
                       "CollectionType=\"Temporal\">\n";
    std::size_t frame = 0;
    for (const FileSegment& segment : segments)
        for (std::uint64_t k = 0; k < segment.rows; ++k, ++frame) {
            const Row row{segment, k};
            fmt::format_to(std::back_inserter(text),
                           "<Grid Name=\"step {0}\"><Time Value=\"{0}\"/><Topology "
                           "TopologyType=\"Polyvertex\" NumberOfElements=\"{1}\"/>"
                           "<Geometry GeometryType=\"XYZ\">{2}</Geometry>",
                           steps[frame], layout.system.n_discs,
                           numbers(row, layout, "position", true));
            text += fixed(file, layout, "radius", "Float") + fixed(file, layout, "species", "Int");
            if (layout.has_velocity)
                text += attribute("velocity", "Vector", numbers(row, layout, "velocity", true));
            layout.columns.for_each([&](SideColumn column) {
                const char* const name = info_of(column).shown;
                text += attribute(name, "Scalar", numbers(row, layout, name, false));
            });
            text += "</Grid>\n";
        }
    text += "</Grid></Domain></Xdmf>\n";
    replace_file(std::filesystem::path(path).replace_extension(".xdmf").string(), text);
}

} // namespace carrom
