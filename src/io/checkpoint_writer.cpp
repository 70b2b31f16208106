// SPDX-License-Identifier: BSD-3-Clause
// Rank 0 makes the file with all its structure and takes its room on disk; then the ranks fill in the columns. So what
// is written side by side is numbers alone, at places that no longer move.
#include <algorithm>
#include <array>
#include <cstring>
#include <functional>
#include <vector>

#include <fcntl.h>
#include <unistd.h>

#include "carrom/core/state_hash.hpp"
#include "carrom/io/checkpoint.hpp"
#include "carrom/parallel/slabs.hpp"
#include "checkpoint_fields.hpp"
#include "files.hpp"
#include "h5md.hpp"
#include "seal.hpp"

namespace carrom {

namespace {

constexpr std::uint64_t bytes_per_disc = sizeof(std::uint64_t) * checkpoint_columns.size() + 6 * sizeof(float);
constexpr std::uint64_t bytes_of_structure = 1 << 20;

/// The file beside its place; gone again unless it was renamed, so that half a file takes no room on a full disk.
class PartialFile {
public:
    PartialFile(std::string path, const Communicator& communicator) : path_(std::move(path)), is_mine_(communicator.is_root()) {
        if (is_mine_) ::unlink(path_.c_str());
    }
    ~PartialFile() { if (is_mine_) ::unlink(path_.c_str()); }
    PartialFile(const PartialFile&) = delete;
    PartialFile& operator=(const PartialFile&) = delete;
    const std::string& path() const { return path_; }

private:
    std::string path_;
    bool is_mine_;
};

void create_column(hid_t parent, const char* name, std::span<const hsize_t> dimensions, hid_t type) {
    const h5::Properties creation = h5::dataset_creation();
    h5::checked(H5Pset_alloc_time(creation.id(), H5D_ALLOC_TIME_EARLY), name);
    h5::checked(H5Pset_fill_time(creation.id(), H5D_FILL_TIME_NEVER), name);
    const h5::Dataset dataset(
        h5::checked(H5Dcreate2(parent, name, type, h5::space(dimensions).id(), H5P_DEFAULT, creation.id(), H5P_DEFAULT), name));
}

/// A group of one frame: its step and time here, its `value` is the caller's.
h5::Group create_frame(hid_t parent, const char* name, const CheckpointHeader& header) {
    h5::Group group = h5::create_group(parent, name);
    const std::array<hsize_t, 1> one = {1};
    const auto time = static_cast<double>(header.step);
    h5::write_whole(group.id(), "step", one, H5T_NATIVE_INT64, &header.step);
    h5::write_whole(group.id(), "time", one, H5T_NATIVE_DOUBLE, &time);
    return group;
}

void create_structure(const std::string& path, const CheckpointHeader& header) {
    h5::File file = h5::create_file(path, seal_size);
    h5md::write_metadata(file.id(), header.program_version);
    {
        const h5::Group particles = h5::create_group(file.id(), "particles");
        const h5::Group discs = h5::create_group(particles.id(), "discs");
        const h5::Group box = h5md::create_box(discs.id());
        const std::array<double, 3> edges = {header.box_size, header.box_size, 1};
        h5::write_whole(create_frame(box.id(), "edges", header).id(), "value", std::array<hsize_t, 2>{1, 3}, H5T_NATIVE_DOUBLE, edges.data());
        const std::array<hsize_t, 3> vectors = {1, header.n_discs, 3};
        for (const char* name : {"position", "velocity"})
            create_column(create_frame(discs.id(), name, header).id(), "value", vectors, H5T_NATIVE_FLOAT);

        const h5::Group carrom = h5::create_group(file.id(), "carrom");
        write_header(h5::create_group(carrom.id(), "run").id(), header);
        const h5::Group columns = h5::create_group(carrom.id(), "discs");
        for (const Column& column : checkpoint_columns)
            create_column(columns.id(), column.name, std::array<hsize_t, 1>{header.n_discs}, type_of(column));
    }
    file.close("cannot be written");
}

/// A dataset to be filled, and how a disc becomes its bytes.
struct Target {
    std::string path;
    hid_t type;
    std::size_t bytes_per_disc;
    std::function<void(std::span<const Disc>, std::byte*)> put;
    h5::Dataset dataset;
};

/// What `number_of` makes of each disc, one after the other.
template <class NumberOf> void put_each(std::span<const Disc> discs, std::byte* out, const NumberOf& number_of) {
    for (const Disc& disc : discs) {
        const auto number = number_of(disc);
        std::memcpy(out, &number, sizeof number);
        out += sizeof number;
    }
}

std::vector<Target> targets_of(const CheckpointHeader& header) {
    std::vector<Target> targets;
    for (const Column& column : checkpoint_columns)
        targets.push_back({std::string("/carrom/discs/") + column.name, type_of(column), sizeof(std::uint64_t),
                           [&column](std::span<const Disc> discs, std::byte* out) {
                               std::visit([&](auto field) { put_each(discs, out, [=](const Disc& disc) { return disc.*field; }); }, column.field);
                           }, {}});
    const double clock = header.clock(), k = static_cast<double>(header.micro_steps);
    const auto vector_of = [](double x, double y) { return std::array<float, 3>{static_cast<float>(x), static_cast<float>(y), 0}; };
    targets.push_back({"/particles/discs/position/value", H5T_NATIVE_FLOAT, 3 * sizeof(float),
                       [=](std::span<const Disc> discs, std::byte* out) {
                           put_each(discs, out, [=](const Disc& disc) { return vector_of(disc.x_at(clock), disc.y_at(clock)); });
                       }, {}});
    targets.push_back({"/particles/discs/velocity/value", H5T_NATIVE_FLOAT, 3 * sizeof(float),
                       [=](std::span<const Disc> discs, std::byte* out) {
                           put_each(discs, out, [=](const Disc& disc) { return vector_of(disc.vx * k, disc.vy * k); });
                       }, {}});
    return targets;
}

/// The ranks' shares of all datasets, each written by its rank in pieces that stay in cache while they are taken apart.
class ColumnWriter {
public:
    ColumnWriter(const std::string& path, const CheckpointHeader& header, const Slab<Disc>& slab, const Communicator& communicator)
        : path_(path), slab_(slab), communicator_(communicator),
          first_(slab_begin(communicator.rank(), header.n_discs, communicator.size())), targets_(targets_of(header)) {}

    /// A file that could not be written is not closed: closing writes again, and where that fails it does not come back.
    ~ColumnWriter() {
        for (Target& target : targets_) target.dataset.abandon();
        file_.abandon();
    }
    ColumnWriter(const ColumnWriter&) = delete;
    ColumnWriter& operator=(const ColumnWriter&) = delete;

    void write() {
        on_ranks([&] {
            const Deadline deadline(path_);
            file_ = h5::open_file(path_, h5::Access::write, communicator_);
        });
        on_ranks([&] {
            const Deadline deadline(path_);
            for (Target& target : targets_) target.dataset = h5::open_dataset(file_.id(), target.path.c_str());
        });
        // Each rank brings to disk what it has written: on several nodes it is in caches of their own.
        on_ranks([&] {
            const Descriptor disk(path_, O_WRONLY);
            for (std::uint64_t row = 0; row < slab_.size(); row += rows_per_piece) {
                write_piece(row, std::min<std::uint64_t>(row + rows_per_piece, slab_.size()));
                if (row % (64 * rows_per_piece) == 0) disk.start_sync();
            }
            disk.sync();
        });
        on_ranks([&] {
            const Deadline deadline(path_);
            for (Target& target : targets_) target.dataset.close("cannot be closed");
        });
        on_ranks([&] {
            const Deadline deadline(path_);
            file_.close("cannot be closed");
        });
    }

private:
    template <class Act> void on_ranks(const Act& act) const { on_all(communicator_, path_, ExitCode::output_failure, act); }

    void write_piece(std::uint64_t begin, std::uint64_t end) {
        piece_.clear();
        for (std::uint64_t row = begin; row < end; ++row) piece_.push_back(slab_[row]);
        for (const Target& target : targets_) {
            bytes_.resize((end - begin) * target.bytes_per_disc);
            target.put(piece_, bytes_.data());
            h5::write_rows(target.dataset.id(), {first_ + begin, first_ + end}, target.type, bytes_.data());
        }
    }

    const std::string& path_;
    const Slab<Disc>& slab_;
    const Communicator& communicator_;
    std::uint64_t first_; ///< the id of the slab's first disc
    std::vector<Target> targets_;
    h5::File file_;
    std::vector<Disc> piece_;
    std::vector<std::byte> bytes_;
};

void fill_sums(CheckpointHeader& header, std::span<const Disc> discs, const Communicator& communicator) {
    const StateHash hash = hash_of(discs);
    std::array<std::uint64_t, 4> sums = {0, 0, hash.low, hash.high};
    for (const Disc& disc : discs) {
        sums[0] += disc.wall_collisions;
        sums[1] += disc.pair_collisions;
    }
    communicator.sum(sums);
    header.wall_collisions = sums[0];
    header.pair_collisions = sums[1] / 2;
    header.state_hash = to_string(StateHash{sums[2], sums[3]});
}

} // namespace

void write_checkpoint(const std::string& path, CheckpointHeader header, std::span<const Disc> discs,
                      const Communicator& communicator) {
    header.n_discs = communicator.sum(std::uint64_t{discs.size()});
    fill_sums(header, discs, communicator);
    const Slab<Disc> slab = to_slabs(communicator, discs, header.n_discs, [](const Disc& disc) { return disc.id; });
    const PartialFile partial(path + ".partial", communicator);
    on_root(communicator, path, ExitCode::output_failure, [&] {
        check_room(folder_of(path), header.n_discs * bytes_per_disc + bytes_of_structure);
        create_structure(partial.path(), header);
        reserve(partial.path());
    });
    ColumnWriter(partial.path(), header, slab, communicator).write();
    seal(partial.path(), communicator);
    on_root(communicator, path, ExitCode::output_failure, [&] { rename_durably(partial.path(), path); });
}

} // namespace carrom
