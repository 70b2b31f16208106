// SPDX-License-Identifier: BSD-3-Clause
#include "io/trajectory.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <filesystem>
#include <numeric>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "io/files.hpp"
#include "io/h5md.hpp"
#include "io/read_columns.hpp"
#include "io/recorded_run.hpp"
#include "io/segmented_file.hpp"
#include "io/xdmf.hpp"
#include "parallel/exchange.hpp"

namespace carrom {

namespace {

constexpr const char* step_path = "/particles/discs/box/edges/step";
constexpr const char* time_path = "/particles/discs/box/edges/time";
constexpr const char* edges_path = "/particles/discs/box/edges/value";

/// A disc as it travels to rank 0: what it shows at the time of the frame.
struct ShownDisc {
    DiscId id = 0;
    double position[2] = {}, velocity[2] = {};
    std::uint64_t collisions[2] = {}; ///< with walls, with discs
    double angular_velocity = 0;
};

/// What a frame has of each disc.
struct Field {
    const char* name;
    hsize_t width; ///< numbers of a disc
    bool is_real;
    /// Component k; the bits of a double where it is real.
    std::uint64_t (*bits)(const ShownDisc&, std::size_t k);
};

std::uint64_t bits_of(double number) { return std::bit_cast<std::uint64_t>(number); }

std::vector<Field> fields_of(const TrajectoryLayout& layout) {
    std::vector<Field> fields;
    if (layout.has_position)
        fields.push_back({"position", 3, true, [](const ShownDisc& disc, std::size_t k) {
                              return bits_of(k < 2 ? disc.position[k] : 0);
                          }});
    if (layout.has_velocity)
        fields.push_back({"velocity", 3, true, [](const ShownDisc& disc, std::size_t k) {
                              return bits_of(k < 2 ? disc.velocity[k] : 0);
                          }});
    if (layout.has_collisions)
        fields.push_back({"collisions", 2, false,
                          [](const ShownDisc& disc, std::size_t k) { return disc.collisions[k]; }});
    if (layout.has_angular_velocity)
        fields.push_back({"angular_velocity", 1, true, [](const ShownDisc& disc, std::size_t) {
                              return bits_of(disc.angular_velocity);
                          }});
    return fields;
}

/// One for each field, then steps and times.
std::vector<RecordedColumn> columns_of(const TrajectoryLayout& layout) {
    const hid_t real = layout.is_single ? H5T_IEEE_F32LE : H5T_IEEE_F64LE;
    std::vector<RecordedColumn> columns;
    for (const Field& field : fields_of(layout)) {
        RecordedColumn column{fmt::format("/particles/discs/{}/value", field.name),
                              field.is_real ? real : H5T_STD_U64LE,
                              {layout.system.n_discs}};
        if (field.width > 1) column.row.push_back(field.width);
        columns.push_back(std::move(column));
    }
    columns.push_back({step_path, H5T_STD_I64LE, {}});
    columns.push_back({time_path, H5T_IEEE_F64LE, {}});
    return columns;
}

/// The same for all frames: where walls move it holds the discs until the last step, which a
/// restart may change. Deflated it takes hardly any room.
void write_edges(hid_t edges, const RecordedSystem& system, hsize_t n_frames) {
    std::vector<double> values;
    for (hsize_t frame = 0; frame < n_frames; ++frame)
        for (const double edge : h5md::edges_of(system)) values.push_back(edge);
    const std::array<hsize_t, 2> sizes = {n_frames, 3}, chunk = {1 << 14, 3};
    const h5::Properties creation = h5::dataset_creation();
    h5::checked(H5Pset_chunk(creation.id(), 2, chunk.data()), edges_path);
    h5::checked(H5Pset_deflate(creation.id(), 1), edges_path);
    const std::array<hsize_t, 2> largest = {H5S_UNLIMITED, 3};
    h5::Dataset dataset(
        h5::checked(H5Dcreate2(edges, "value", H5T_IEEE_F64LE, h5::space(sizes, largest).id(),
                               H5P_DEFAULT, creation.id(), H5P_DEFAULT),
                    edges_path));
    if (n_frames > 0)
        h5::checked(
            H5Dwrite(dataset.id(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()),
            edges_path);
    dataset.close(edges_path);
}

/// Steps and times stand once; every element links to them, as H5MD allows.
void write_structure(hid_t file, const TrajectoryLayout& layout, std::uint64_t n_frames) {
    h5md::write_system(file, layout.system);
    write_recorded_run(file, layout.run);
    const h5::Group edges = h5::create_group(file, "/particles/discs/box/edges");
    write_edges(edges.id(), layout.system, n_frames);
    for (const Field& field : fields_of(layout)) {
        const h5::Group element = h5::create_group(
            file, (std::string("/particles/discs/") + field.name).c_str());
        for (const auto& [name, path] :
             {std::pair("step", step_path), std::pair("time", time_path)})
            h5::checked(H5Lcreate_soft(path, element.id(), name, H5P_DEFAULT, H5P_DEFAULT), name);
    }
}

/// The discs of all ranks on rank 0, slab after slab of ids.
class SlabStream {
public:
    /// `spins` may be empty.
    SlabStream(std::span<const Disc> discs, std::span<const double> spins, double clock,
               double velocity_unit, const Communicator& communicator)
        : discs_(discs), spins_(spins), clock_(clock), velocity_unit_(velocity_unit),
          communicator_(communicator), order_(discs.size()) {
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
        return slab_;
    }

private:
    ShownDisc shown(LocalIndex i) const {
        const Disc& disc = discs_[i];
        return {disc.id,
                {disc.x_at(clock_), disc.y_at(clock_)},
                {disc.vx * velocity_unit_, disc.vy * velocity_unit_},
                {disc.wall_collisions, disc.pair_collisions},
                spins_.empty() ? 0 : spins_[i] * velocity_unit_};
    }

    std::span<const Disc> discs_;
    std::span<const double> spins_;
    double clock_, velocity_unit_;
    const Communicator& communicator_;
    std::vector<LocalIndex> order_;
    std::size_t next_ = 0;
    std::vector<ShownDisc> slab_;
};

/// A field of some discs as the file has it.
std::vector<std::byte> bytes_of(const Field& field, std::span<const ShownDisc> slab,
                                bool is_single) {
    std::vector<std::byte> bytes;
    bytes.reserve(slab.size() * field.width * sizeof(double));
    for (const ShownDisc& disc : slab)
        for (std::size_t k = 0; k < field.width; ++k) {
            const std::uint64_t bits = field.bits(disc, k);
            const auto single = static_cast<float>(std::bit_cast<double>(bits));
            const auto number = field.is_real && is_single ? std::as_bytes(std::span(&single, 1))
                                                           : std::as_bytes(std::span(&bits, 1));
            bytes.insert(bytes.end(), number.begin(), number.end());
        }
    return bytes;
}

} // namespace

struct Trajectory::State {
    State(const std::string& path, const TrajectoryLayout& layout)
        : file(path, columns_of(layout), [&layout](hid_t index, std::uint64_t n_frames) {
              write_structure(index, layout, n_frames);
          }) {}
    SegmentedFile file;
    std::vector<std::int64_t> steps; ///< of the frames there are
    std::size_t n_described = 0;     ///< of them in the XDMF file
};

Trajectory::Trajectory(const std::string& path, const TrajectoryLayout& layout,
                       const Communicator& communicator)
    : path_(path), layout_(layout), communicator_(communicator) {
    if (communicator_.is_root()) state_ = std::make_unique<State>(path_, layout_);
}

Trajectory::~Trajectory() = default;

void Trajectory::begin() {
    on_root(communicator_, path_, ExitCode::output_failure, [&] {
        check_room(folder_of(path_), 1 << 20);
        state_->file.create();
        state_->steps.clear();
    });
}

std::int64_t Trajectory::go_on(std::int64_t step, const DifferenceFrom& difference_from) {
    std::uint64_t is_there = 0;
    on_root(communicator_, path_, ExitCode::output_failure,
            [&] { is_there = std::filesystem::exists(path_) ? 1 : 0; });
    communicator_.broadcast(is_there);
    if (is_there == 0) {
        begin();
        return -1;
    }
    on_root(communicator_, path_, ExitCode::bad_input, [&] {
        state_->file.go_on(step_path, step, [&](hid_t file) {
            if (!h5::has(file, "/particles/discs")) throw FileError("is no trajectory");
            check_recorded_run(file, difference_from);
            state_->steps = read_numbers(file, step_path);
        });
        state_->steps.resize(state_->file.n_rows());
    });
    commit();
    return communicator_.is_root() && !state_->steps.empty() ? state_->steps.back() : -1;
}

void Trajectory::append(std::int64_t step, std::span<const Disc> discs, double clock,
                        std::span<const double> spins) {
    ensure(!layout_.has_angular_velocity || spins.size() == discs.size(),
           "spins do not run along the discs");
    if (communicator_.is_root())
        state_->file.attempt([&] { static_cast<void>(state_->file.room()); });
    SlabStream stream(discs, layout_.has_angular_velocity ? spins : std::span<const double>{},
                      clock, layout_.velocity_unit, communicator_);
    const std::vector<Field> fields = fields_of(layout_);
    const std::uint64_t n = layout_.system.n_discs;
    for (std::uint64_t begin = 0; begin < n; begin += cells_per_part) {
        const std::span<const ShownDisc> slab = stream.next(begin,
                                                            std::min(begin + cells_per_part, n));
        if (!communicator_.is_root()) continue;
        state_->file.attempt([&] {
            for (std::size_t k = 0; k < fields.size(); ++k)
                state_->file.write(k, begin, slab.size(),
                                   bytes_of(fields[k], slab, layout_.is_single));
        });
    }
    on_root(communicator_, path_, ExitCode::output_failure, [&] {
        state_->file.attempt([&] {
            const auto time = static_cast<double>(step);
            state_->file.write(fields.size(), 0, 1, std::as_bytes(std::span(&step, 1)));
            state_->file.write(fields.size() + 1, 0, 1, std::as_bytes(std::span(&time, 1)));
            state_->file.add(1);
        });
        state_->file.close();
        state_->steps.push_back(step);
    });
}

void Trajectory::commit() {
    on_root(communicator_, path_, ExitCode::output_failure, [&] {
        state_->file.commit();
        // Its length is that of all frames: often enough, and never for long.
        if (state_->steps.size() < state_->n_described + state_->n_described / 4 + 1) return;
        write_xdmf(path_, layout_, state_->file.segments(), state_->steps);
        state_->n_described = state_->steps.size();
    });
}

void Trajectory::describe() {
    on_root(communicator_, path_, ExitCode::output_failure,
            [&] { write_xdmf(path_, layout_, state_->file.segments(), state_->steps); });
}

} // namespace carrom
