// SPDX-License-Identifier: BSD-3-Clause
#include "io/trajectory.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <functional>
#include <numeric>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "io/checked_dataset.hpp"
#include "io/h5md.hpp"
#include "io/recorded_run.hpp"
#include "io/segmented_file.hpp"
#include "io/xdmf.hpp"
#include "parallel/exchange.hpp"

namespace carrom {

namespace {

constexpr std::uint64_t discs_at_a_time = std::uint64_t{1} << 16;

/// A disc as it travels to rank 0: what it shows at the time of the frame.
struct ShownDisc {
    DiscId id = 0;
    double position[2] = {}, velocity[2] = {};
    std::uint64_t collisions[2] = {}; ///< with walls, with discs
    std::int32_t image[2] = {};
    double columns[n_side_columns] = {};
    double psi6[2] = {};
    std::uint64_t n_neighbours = 0;
};

/// What a frame has of each disc.
struct Field {
    const char* name;
    hsize_t width; ///< numbers of a disc
    hid_t type;
    std::string unit;
    /// Component k, in the low bits; those of a double where it is real.
    std::function<std::uint64_t(const ShownDisc&, std::size_t k)> bits;
};

std::uint64_t bits_of(double number) { return std::bit_cast<std::uint64_t>(number); }

std::vector<Field> fields_of(const TrajectoryLayout& layout) {
    const auto unit = std::bind_front(h5md::unit_of, std::cref(layout.system));
    const hid_t real = layout.is_single ? H5T_IEEE_F32LE : H5T_IEEE_F64LE;
    std::vector<Field> fields;
    if (layout.has_position)
        fields.push_back(
            {"position", 3, real, unit(1, 0), [](const ShownDisc& disc, std::size_t k) {
                 return bits_of(k < 2 ? disc.position[k] : 0);
             }});
    if (layout.has_velocity)
        fields.push_back(
            {"velocity", 3, real, unit(1, -1), [](const ShownDisc& disc, std::size_t k) {
                 return bits_of(k < 2 ? disc.velocity[k] : 0);
             }});
    if (layout.has_collisions)
        fields.push_back({"collisions", 2, H5T_STD_U64LE, "",
                          [](const ShownDisc& disc, std::size_t k) { return disc.collisions[k]; }});
    if (layout.has_psi6)
        fields.push_back({"psi6", 2, real, "", [](const ShownDisc& disc, std::size_t k) {
                              return bits_of(disc.psi6[k]);
                          }});
    if (layout.has_neighbours)
        fields.push_back({"neighbours", 1, H5T_STD_U64LE, "",
                          [](const ShownDisc& disc, std::size_t) { return disc.n_neighbours; }});
    if (layout.has_image)
        fields.push_back({"image", 3, H5T_STD_I32LE, "", [](const ShownDisc& disc, std::size_t k) {
                              return static_cast<std::uint64_t>(k < 2 ? disc.image[k] : 0);
                          }});
    layout.columns.for_each([&](SideColumn column) {
        fields.push_back(
            {info_of(column).shown, 1, real, unit(0, info_of(column).is_rate ? -1 : 0),
             [place = static_cast<std::size_t>(column)](const ShownDisc& disc, std::size_t) {
                 return bits_of(disc.columns[place]);
             }});
    });
    return fields;
}

/// One for each field, then step, time and box.
std::vector<RecordedColumn> columns_of(const TrajectoryLayout& layout) {
    std::vector<RecordedColumn> columns;
    for (const Field& field : fields_of(layout)) {
        RecordedColumn column{fmt::format("/particles/discs/{}/value", field.name),
                              field.type,
                              {layout.system.n_discs},
                              field.unit};
        if (field.width > 1) column.row.push_back(field.width);
        columns.push_back(std::move(column));
    }
    columns.push_back({h5md::step_path, H5T_STD_I64LE, {}});
    columns.push_back({h5md::time_path, H5T_IEEE_F64LE, {}, h5md::unit_of(layout.system, 0, 1)});
    columns.push_back({h5md::edges_path, H5T_IEEE_F64LE, {3}, h5md::unit_of(layout.system, 1, 0)});
    return columns;
}

/// Steps and times stand once; every element links to them, as H5MD allows.
void write_structure(hid_t file, const TrajectoryLayout& layout) {
    h5md::write_system(file, layout.system);
    h5md::write_bodies(file, layout.system);
    write_recorded_run(file, layout.run);
    static_cast<void>(h5::create_group(file, "/particles/discs/box/edges"));
    for (const Field& field : fields_of(layout)) {
        const h5::Group element = h5::create_group(
            file, (std::string("/particles/discs/") + field.name).c_str());
        for (const auto& [name, path] :
             {std::pair("step", h5md::step_path), std::pair("time", h5md::time_path)})
            h5::checked(H5Lcreate_soft(path, element.id(), name, H5P_DEFAULT, H5P_DEFAULT), name);
    }
}

/// The discs of all ranks on rank 0, slab after slab of ids.
class SlabStream {
public:
    SlabStream(std::span<const Disc> discs, const SideSpans& columns,
               std::span<const BondOrder> orders, std::span<const DiscImage> images, double clock,
               const TrajectoryLayout& layout, const Communicator& communicator)
        : discs_(discs), columns_(columns), orders_(orders), images_(images), clock_(clock),
          layout_(layout), communicator_(communicator), order_(discs.size()) {
        std::iota(order_.begin(), order_.end(), LocalIndex{0});
        std::sort(order_.begin(), order_.end(),
                  [discs](LocalIndex a, LocalIndex b) { return discs[a].id < discs[b].id; });
    }

    /// Ids [begin, end), which follow those of the last call; nothing on other ranks.
    /// **Collective.**
    std::span<const ShownDisc> next(std::uint64_t begin, std::uint64_t end) {
        std::vector<ShownDisc> mine;
        for (; next_ < order_.size() && discs_[order_[next_]].id < end; ++next_)
            mine.push_back(shown(order_[next_]));
        slab_.resize(communicator_.is_root() ? end - begin : 0);
        const auto place = [&](std::span<const ShownDisc> some) {
            for (const ShownDisc& disc : some) slab_[disc.id - begin] = disc;
        };
        stream_to_root(communicator_, mine, place, end - begin);
        if (layout_.has_image) add_images(begin, end);
        return slab_;
    }

private:
    void add_images(std::uint64_t begin, std::uint64_t end) {
        std::size_t n = 0;
        while (n < images_.size() && images_[n].id < end) ++n;
        const auto place = [&](std::span<const DiscImage> some) {
            for (const DiscImage& image : some) {
                slab_[image.id - begin].image[0] = image.x;
                slab_[image.id - begin].image[1] = image.y;
            }
        };
        stream_to_root(communicator_, images_.first(n), place, end - begin);
        images_ = images_.subspan(n);
    }

    ShownDisc shown(LocalIndex i) const {
        const Disc& disc = discs_[i];
        const double unit = layout_.velocity_unit;
        ShownDisc shown = {disc.id,
                           {disc.x_at(clock_), disc.y_at(clock_)},
                           {disc.vx * unit, disc.vy * unit},
                           {disc.wall_collisions, disc.pair_collisions}};
        layout_.columns.for_each([&](SideColumn column) {
            shown.columns[static_cast<std::size_t>(column)] = columns_[column][i] *
                                                              (info_of(column).is_rate ? unit : 1);
        });
        if (!orders_.empty() && orders_[i].has_cell()) {
            shown.psi6[0] = orders_[i].real;
            shown.psi6[1] = orders_[i].imaginary;
            shown.n_neighbours = static_cast<std::uint64_t>(orders_[i].n_neighbours);
        }
        return shown;
    }

    std::span<const Disc> discs_;
    SideSpans columns_;
    std::span<const BondOrder> orders_;
    std::span<const DiscImage> images_; ///< of ids that are still to come
    double clock_;
    const TrajectoryLayout& layout_;
    const Communicator& communicator_;
    std::vector<LocalIndex> order_;
    std::size_t next_ = 0;
    std::vector<ShownDisc> slab_;
};

/// A field of some discs as the file has it.
std::vector<std::byte> bytes_of(const Field& field, std::span<const ShownDisc> slab) {
    const bool is_single = H5Tequal(field.type, H5T_IEEE_F32LE) > 0;
    const std::size_t size = H5Tget_size(field.type);
    std::vector<std::byte> bytes;
    bytes.reserve(slab.size() * field.width * sizeof(double));
    for (const ShownDisc& disc : slab)
        for (std::size_t k = 0; k < field.width; ++k) {
            const std::uint64_t bits = field.bits(disc, k);
            const auto single = static_cast<float>(std::bit_cast<double>(bits));
            const auto number = is_single ? std::as_bytes(std::span(&single, 1))
                                          : std::as_bytes(std::span(&bits, 1)).first(size);
            bytes.insert(bytes.end(), number.begin(), number.end());
        }
    return bytes;
}

} // namespace

struct Trajectory::State {
    State(const std::string& path, const TrajectoryLayout& layout, const Communicator& communicator)
        : file(
              path, columns_of(layout), [&layout](hid_t index) { write_structure(index, layout); },
              communicator) {}
    SegmentedFile file;
    std::vector<std::int64_t> steps; ///< of the frames there are, on rank 0
    std::size_t n_described = 0;     ///< of them in the XDMF file
};

Trajectory::Trajectory(const std::string& path, const TrajectoryLayout& layout,
                       const Communicator& communicator)
    : path_(path), layout_(layout), communicator_(communicator) {
    state_ = std::make_unique<State>(path_, layout_, communicator_);
}

Trajectory::~Trajectory() = default;

void Trajectory::begin() {
    state_->file.begin();
    state_->steps.clear();
}

std::int64_t Trajectory::go_on(std::int64_t step, const DifferenceFrom& difference_from) {
    std::vector<std::int64_t>& steps = state_->steps;
    const bool is_there = state_->file.go_on(h5md::step_path, step, [&](hid_t file) {
        if (!h5::has(file, "/particles/discs")) throw FileError("is no trajectory");
        check_recorded_run(file, difference_from);
        steps = h5::read_column<std::int64_t>(file, h5md::step_path);
    });
    if (!is_there || !communicator_.is_root()) return -1;
    steps.resize(state_->file.n_rows());
    return steps.empty() ? -1 : steps.back();
}

void Trajectory::append(std::int64_t step, std::span<const Disc> discs, double clock,
                        const SideSpans& columns, std::span<const BondOrder> orders,
                        std::span<const DiscImage> images) {
    ensure(orders.size() == discs.size() || !(layout_.has_psi6 || layout_.has_neighbours),
           "psi6 does not run along the discs");
    layout_.columns.for_each([&](SideColumn column) {
        ensure(columns[column].size() == discs.size(), "a column does not run along the discs");
    });
    SegmentedFile& file = state_->file;
    file.attempt([&] { static_cast<void>(file.room()); });
    SlabStream stream(discs, columns, orders, images, clock, layout_, communicator_);
    const std::vector<Field> fields = fields_of(layout_);
    const std::uint64_t n = layout_.system.n_discs;
    for (std::uint64_t begin = 0; begin < n; begin += discs_at_a_time) {
        const std::span<const ShownDisc> slab = stream.next(begin,
                                                            std::min(begin + discs_at_a_time, n));
        file.attempt([&] {
            for (std::size_t k = 0; k < fields.size(); ++k)
                file.write(k, bytes_of(fields[k], slab));
        });
    }
    file.attempt([&] {
        const auto time = static_cast<double>(step);
        const std::array<double, 3> edges = h5md::edges_of(layout_.system);
        file.write(fields.size(), std::as_bytes(std::span(&step, 1)));
        file.write(fields.size() + 1, std::as_bytes(std::span(&time, 1)));
        file.write(fields.size() + 2, std::as_bytes(std::span(edges)));
        file.add(1);
    });
    file.finish_addition();
    state_->steps.push_back(step);
}

void Trajectory::commit() {
    state_->file.commit();
    // Its length is that of all frames: often enough, and never for long.
    if (communicator_.any(communicator_.is_root() &&
                          state_->steps.size() >=
                              state_->n_described + state_->n_described / 4 + 1))
        describe();
}

void Trajectory::describe() {
    on_root(communicator_, path_, ExitCode::output_failure, [&] {
        write_xdmf(path_, layout_, state_->file.segments(), state_->steps);
        state_->n_described = state_->steps.size();
    });
}

} // namespace carrom
