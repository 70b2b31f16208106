// SPDX-License-Identifier: BSD-3-Clause
#include "io/trajectory.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <numeric>
#include <vector>

#include "io/appended_file.hpp"
#include "io/checked_dataset.hpp"
#include "io/crash_guard.hpp"
#include "io/files.hpp"
#include "io/h5md.hpp"
#include "io/recorded_run.hpp"
#include "io/xdmf.hpp"
#include "parallel/exchange.hpp"

namespace carrom {

namespace {

constexpr std::uint64_t most_rows_per_chunk = std::uint64_t{1} << 16;

/// Chunks of one size that hold a frame with hardly any room to spare.
std::uint64_t rows_per_chunk(std::uint64_t n) {
    const std::uint64_t n_chunks = (n + most_rows_per_chunk - 1) / most_rows_per_chunk;
    return (n + n_chunks - 1) / n_chunks;
}

/// Whole chunks, so that none is read again to be filled up.
std::uint64_t rows_per_slab(std::uint64_t n) { return 4 * rows_per_chunk(n); }

/// A disc as it travels to rank 0: what it shows at the time of the frame.
struct ShownDisc {
    DiscId id = 0;
    double position[2] = {}, velocity[2] = {};
    std::uint64_t collisions[2] = {}; ///< with walls, with discs
    double angular_velocity = 0;
};

/// A dataset of /particles/discs that grows by a row of n x width numbers a frame, of n numbers
/// where the width is 1.
struct Field {
    std::string path;
    hsize_t width;
    hid_t type; ///< of the file
    hid_t memory_type;
    std::uint64_t (*bits)(const ShownDisc&,
                          std::size_t); ///< component k as the 8 bytes of the memory type
};

std::uint64_t bits_of(double number) { return std::bit_cast<std::uint64_t>(number); }

std::vector<Field> fields_of(const TrajectoryLayout& layout) {
    const hid_t real = layout.is_single ? H5T_IEEE_F32LE : H5T_IEEE_F64LE;
    std::vector<Field> fields;
    if (layout.has_position)
        fields.push_back(
            {"position", 3, real, H5T_NATIVE_DOUBLE, [](const ShownDisc& disc, std::size_t k) {
                 return bits_of(k < 2 ? disc.position[k] : 0);
             }});
    if (layout.has_velocity)
        fields.push_back(
            {"velocity", 3, real, H5T_NATIVE_DOUBLE, [](const ShownDisc& disc, std::size_t k) {
                 return bits_of(k < 2 ? disc.velocity[k] : 0);
             }});
    if (layout.has_collisions)
        fields.push_back({"collisions", 2, H5T_STD_U64LE, H5T_NATIVE_UINT64,
                          [](const ShownDisc& disc, std::size_t k) { return disc.collisions[k]; }});
    if (layout.has_angular_velocity)
        fields.push_back(
            {"angular_velocity", 1, real, H5T_NATIVE_DOUBLE,
             [](const ShownDisc& disc, std::size_t) { return bits_of(disc.angular_velocity); }});
    return fields;
}

/// Of a block of frames and discs of a field: it has one axis fewer where a disc has one number.
std::vector<hsize_t> sizes_of(const Field& field, hsize_t n_frames, hsize_t n_discs) {
    if (field.width == 1) return {n_frames, n_discs};
    return {n_frames, n_discs, field.width};
}

void link(hid_t from, const char* name, hid_t to) {
    h5::checked(H5Lcreate_hard(from, name, to, name, H5P_DEFAULT, H5P_DEFAULT), name);
}

/// What never changes has no step and no time (H5MD 1.1, "time-independent data").
void write_fixed(hid_t discs, const char* name, const std::vector<double>& values) {
    if (values.empty()) return;
    h5::write_whole(discs, name, std::array<hsize_t, 1>{values.size()}, H5T_IEEE_F64LE,
                    values.data());
}

constexpr const char* open_boundaries_path = "/parameters/open_sides";

/// Only where there are any: other files need no such entry.
void write_open_boundaries(hid_t file, const TrajectoryLayout& layout) {
    std::array<std::int32_t, 4> flags{};
    std::copy(layout.open_boundaries.begin(), layout.open_boundaries.end(), flags.begin());
    if (flags == std::array<std::int32_t, 4>{}) return;
    h5::write_whole(file, open_boundaries_path, std::array<hsize_t, 1>{flags.size()},
                    H5T_NATIVE_INT32, flags.data());
}

/// Steps and times stand once; every element links to them, as H5MD allows.
void create_structure(hid_t file, const TrajectoryLayout& layout) {
    const std::vector<Field> fields = fields_of(layout);
    h5md::write_metadata(file, layout.program_version);
    h5::write_scalar(h5::create_group(file, "parameters").id(), "radius", layout.radius);
    write_open_boundaries(file, layout);
    write_recorded_run(file, layout.run);
    const h5::Group particles = h5::create_group(file, "particles");
    const h5::Group discs = h5::create_group(particles.id(), "discs");
    write_fixed(discs.id(), "radius", layout.radii);
    write_fixed(discs.id(), "mass", layout.masses);
    const h5::Group box = h5md::create_box(discs.id(), layout.is_periodic_x, layout.is_periodic_y),
                    edges = h5::create_group(box.id(), "edges");
    create_growing(edges.id(), "step", H5T_STD_I64LE, {}, std::array<hsize_t, 1>{256}, 0);
    create_growing(edges.id(), "time", H5T_IEEE_F64LE, {}, std::array<hsize_t, 1>{256}, 0);
    create_growing(edges.id(), "value", H5T_IEEE_F64LE, std::array<hsize_t, 1>{3},
                   std::array<hsize_t, 2>{256, 3}, 0);
    for (const Field& field : fields) {
        const h5::Group element = h5::create_group(discs.id(), field.path.c_str());
        link(edges.id(), "step", element.id());
        link(edges.id(), "time", element.id());
        const std::vector<hsize_t> frame = sizes_of(field, 1, layout.n_discs);
        create_growing(element.id(), "value", field.type, std::span(frame).subspan(1),
                       sizes_of(field, 1, rows_per_chunk(layout.n_discs)), layout.compression);
    }
}

std::string value_path(const Field& field) { return "/particles/discs/" + field.path + "/value"; }
constexpr const char* step_path = "/particles/discs/box/edges/step";
constexpr const char* time_path = "/particles/discs/box/edges/time";
constexpr const char* edges_path = "/particles/discs/box/edges/value";

void set_frames(hid_t file, const TrajectoryLayout& layout, hsize_t n) {
    for (const Field& field : fields_of(layout)) set_length(file, value_path(field).c_str(), n);
    for (const char* path : {step_path, time_path, edges_path}) set_length(file, path, n);
}

std::array<double, 3> edges_of(const TrajectoryLayout& layout) {
    return {layout.box_size, layout.box_size, 1};
}

/// Walls that move make the box that holds all frames depend on the last step, which a restart may
/// change.
void renew_box(hid_t file, const TrajectoryLayout& layout, hsize_t n_frames) {
    std::vector<double> there(3 * n_frames), wanted;
    for (hsize_t frame = 0; frame < n_frames; ++frame)
        for (const double edge : edges_of(layout)) wanted.push_back(edge);
    const std::array<hsize_t, 2> start = {0, 0}, count = {n_frames, 3};
    {
        const h5::Dataset edges = h5::open_checked(file, edges_path, {n_frames, 3});
        h5::checked(
            H5Dread(edges.id(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, there.data()),
            edges_path);
    }
    if (there != wanted)
        write_block(file, edges_path, start, count, H5T_NATIVE_DOUBLE, wanted.data());
}

void check_layout(hid_t file, const TrajectoryLayout& layout) {
    const hsize_t n_frames = length_of(file, step_path);
    for (const Field& field : fields_of(layout)) {
        const h5::Dataset dataset = h5::open_checked(file, value_path(field));
        const std::vector<hsize_t> dimensions = h5::dimensions_of(dataset.id());
        const h5::Type type(h5::checked(H5Dget_type(dataset.id()), "cannot look at a dataset"));
        if (dimensions != sizes_of(field, n_frames, layout.n_discs) ||
            H5Tequal(type.id(), field.type) <= 0)
            throw FileError("is of another run: its " + field.path + " has another shape");
    }
    static_cast<void>(h5::open_checked(file, time_path, {n_frames}));
    static_cast<void>(h5::open_checked(file, edges_path, {n_frames, 3}));
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

void write_slab(hid_t file, const TrajectoryLayout& layout, hsize_t frame, std::uint64_t begin,
                std::span<const ShownDisc> slab) {
    std::vector<std::uint64_t> numbers;
    for (const Field& field : fields_of(layout)) {
        numbers.clear();
        for (const ShownDisc& disc : slab)
            for (std::size_t k = 0; k < field.width; ++k) numbers.push_back(field.bits(disc, k));
        const std::array<hsize_t, 3> start = {frame, begin, 0};
        const std::vector<hsize_t> count = sizes_of(field, 1, slab.size());
        write_block(file, value_path(field).c_str(), std::span(start).first(count.size()), count,
                    field.memory_type, numbers.data());
    }
}

/// Step, time and edges come last: a frame counts once it has them.
void write_labels(hid_t file, hsize_t frame, std::int64_t step, const TrajectoryLayout& layout) {
    const std::array<hsize_t, 1> place = {frame}, one = {1};
    const auto time = static_cast<double>(step);
    const std::array<double, 3> edges = edges_of(layout);
    write_block(file, edges_path, std::array<hsize_t, 2>{frame, 0}, std::array<hsize_t, 2>{1, 3},
                H5T_NATIVE_DOUBLE, edges.data());
    write_block(file, time_path, place, one, H5T_NATIVE_DOUBLE, &time);
    write_block(file, step_path, place, one, H5T_NATIVE_INT64, &step);
}

} // namespace

struct Trajectory::State {
    explicit State(const std::string& path) : file(path) {}
    AppendedFile file;
    std::vector<std::int64_t> steps; ///< of the frames there are
    std::size_t n_described = 0;     ///< of them in the XDMF file
};

Trajectory::Trajectory(const std::string& path, const TrajectoryLayout& layout,
                       const Communicator& communicator)
    : path_(path), layout_(layout), communicator_(communicator) {
    if (communicator_.is_root()) state_ = std::make_unique<State>(path);
}

Trajectory::~Trajectory() = default;

void Trajectory::begin() {
    on_root(communicator_, path_, ExitCode::output_failure, [&] {
        check_room(folder_of(path_), 1 << 20);
        state_->file.create([&](hid_t file) { create_structure(file, layout_); });
        state_->steps.clear();
    });
}

std::int64_t Trajectory::go_on(std::int64_t step, const DifferenceFrom& difference_from) {
    std::uint64_t is_there = 0;
    on_root(communicator_, path_, ExitCode::output_failure,
            [&] { is_there = state_->file.reopen() ? 1 : 0; });
    communicator_.broadcast(is_there);
    if (is_there == 0) {
        begin();
        return -1;
    }
    on_root(communicator_, path_, ExitCode::bad_input, [&] {
        const CrashGuard guard(path_);
        {
            const h5::File file = h5::open_file(path_, h5::Access::read);
            if (!h5::has(file.id(), "/particles/discs")) throw FileError("is no trajectory");
            check_recorded_run(file.id(), difference_from);
            check_layout(file.id(), layout_);
        }
        state_->file.change([&](hid_t file) {
            const hsize_t n = count_up_to(file, step_path, step);
            set_frames(file, layout_, n);
            renew_box(file, layout_, n);
            if (H5Lexists(file, open_boundaries_path, H5P_DEFAULT) == 0)
                write_open_boundaries(file, layout_); // an older version's
            state_->steps = read_numbers(file, step_path);
        });
    });
    return communicator_.is_root() && !state_->steps.empty() ? state_->steps.back() : -1;
}

void Trajectory::append(std::int64_t step, std::span<const Disc> discs, double clock,
                        std::span<const double> spins) {
    ensure(!layout_.has_angular_velocity || spins.size() == discs.size(),
           "spins do not run along the discs");
    hsize_t frame = 0;
    on_root(communicator_, path_, ExitCode::output_failure, [&] {
        frame = state_->steps.size();
        state_->file.open();
        state_->file.attempt([&](hid_t file) { set_frames(file, layout_, frame + 1); });
    });
    SlabStream stream(discs, layout_.has_angular_velocity ? spins : std::span<const double>{},
                      clock, layout_.velocity_unit, communicator_);
    const std::uint64_t rows = rows_per_slab(layout_.n_discs);
    for (std::uint64_t begin = 0; begin < layout_.n_discs; begin += rows) {
        const std::span<const ShownDisc> slab = stream.next(
            begin, std::min(begin + rows, layout_.n_discs));
        if (communicator_.is_root())
            state_->file.attempt(
                [&](hid_t file) { write_slab(file, layout_, frame, begin, slab); });
    }
    on_root(communicator_, path_, ExitCode::output_failure, [&] {
        state_->file.attempt([&](hid_t file) { write_labels(file, frame, step, layout_); });
        state_->file.close();
        state_->steps.push_back(step);
    });
}

void Trajectory::commit() {
    on_root(communicator_, path_, ExitCode::output_failure, [&] {
        state_->file.commit();
        // Its length is that of all frames: often enough, and never for long.
        if (state_->steps.size() < state_->n_described + state_->n_described / 4 + 1) return;
        write_xdmf(path_, layout_, state_->steps);
        state_->n_described = state_->steps.size();
    });
}

void Trajectory::describe() {
    on_root(communicator_, path_, ExitCode::output_failure,
            [&] { write_xdmf(path_, layout_, state_->steps); });
}

} // namespace carrom
