// SPDX-License-Identifier: BSD-3-Clause
// First rank 0 reads a file's metadata in a child process, because HDF5 may crash on forged
// metadata. Then rank 0 checks all bytes except the data of discs by a checksum, so that HDF5 uses
// only checked bytes on all ranks. Each rank checks and reads its share of the discs' data by
// H5Dread through MPI-IO.
#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <vector>

#include <fcntl.h>

#include <fmt/format.h>

#include "core/state_hash.hpp"
#include "io/checked_dataset.hpp"
#include "io/checkpoint.hpp"
#include "io/checkpoint_fields.hpp"
#include "io/checksums.hpp"
#include "io/child_process.hpp"
#include "io/files.hpp"
#include "io/segments.hpp"
#include "parallel/slabs.hpp"

namespace carrom {

namespace {

constexpr const char* measurements_path = "/carrom/measurements";
constexpr const char* averages_path = "/carrom/averages";
constexpr const char* watched_path = "/carrom/watched";
constexpr const char* stop_path = "/carrom/stop";
constexpr const char* effects_path = "/carrom/effects";
constexpr const char* sums_path = "/carrom/measurements/sums";

/// Throws if this program never writes such a header. A file with such a header and right checksums
/// has been made by another program.
void check_header(const CheckpointHeader& header) {
    const Frame& frame = header.frame;
    const std::array finite = {frame.x,
                               frame.y,
                               frame.vx,
                               frame.vy,
                               frame.slowing,
                               frame.clock,
                               frame.periods.x,
                               frame.periods.y,
                               frame.periods.offset,
                               frame.periods.speed};
    const bool is_sound = header.micro_steps >= 1 && header.sync_every >= 1 && header.step >= 0 &&
                          header.n_discs > 0 &&
                          header.micro_steps_done / header.micro_steps == header.step &&
                          header.micro_steps_done % header.micro_steps == 0 &&
                          std::isfinite(header.box().longest()) && header.box().shortest() > 0 &&
                          std::isfinite(header.radius) && header.radius > 0 &&
                          std::all_of(finite.begin(), finite.end(),
                                      [](double x) { return std::isfinite(x); });
    if (!is_sound) throw FileError("its numbers contradict each other");
}

/// The contents of a file, without the data of discs.
struct Contents {
    CheckpointHeader header;
    Checksums sums;
    StoredSamples samples; ///< the samples, without the discs' first positions
};

bool is_listed(const Checksums& sums, const std::string& path) {
    return std::any_of(sums.data.begin(), sums.data.end(),
                       [&](const DiscData& data) { return data.path == path; });
}

StoredSamples samples_of(hid_t file, const Checksums& sums) {
    StoredSamples samples;
    for (const SampleColumn& column : sample_columns)
        if (is_listed(sums, column.path)) samples.*column.is_there = true;
    if (h5::has(file, averages_path))
        samples.averages = h5::read_column<std::int64_t>(file, averages_path);
    if (h5::has(file, watched_path))
        samples.watched = h5::read_column<std::int64_t>(file, watched_path);
    if (h5::has(file, stop_path)) samples.stop = h5::read_column<std::int64_t>(file, stop_path);
    if (h5::has(file, effects_path))
        samples.effects = h5::read_column<std::int64_t>(file, effects_path);
    if (!h5::has(file, measurements_path)) return samples;
    samples.sums = h5::read_column<std::int64_t>(file, sums_path);
    if (samples.sums.empty()) throw FileError("its measurements are no list of sums");
    return samples;
}

/// Throws unless every data set of discs exists, has a checksum, and has a row for each disc.
void check_disc_data(const Contents& contents) {
    std::vector<std::string> wanted;
    for (const StateColumn& column : disc_columns) wanted.push_back(path_of(column));
    contents.header.columns.for_each([&](SideColumn column) { wanted.push_back(path_of(column)); });
    for (const SampleColumn& column : sample_columns)
        if (contents.samples.*column.is_there) wanted.push_back(column.path);
    for (const std::string& path : wanted)
        if (!is_listed(contents.sums, path)) throw FileError("has no " + path);
    for (const DiscData& data : contents.sums.data)
        if (data.rows != contents.header.n_discs)
            throw FileError(data.path + " has not got as many discs as the file says");
}

/// Rejects files of version 0.1. They begin with a text, which HDF5 accepts before its signature.
void refuse_old_format(const std::string& path) {
    constexpr std::string_view family = "carrom checkpoint, format ";
    std::string front(family.size(), '\0');
    Descriptor(path, O_RDONLY).read(std::as_writable_bytes(std::span(front)), 0);
    if (front == family)
        throw FileError(fmt::format("is a checkpoint of carrom 0.1; this version reads format {} "
                                    "only. Go on with it in version 0.1, or begin anew",
                                    checkpoint_format));
}

void check_format(hid_t file) {
    std::int64_t format = 0;
    if (!h5::has(file, run_path) || !h5::has(file, format_path))
        throw FileError("is no checkpoint of carrom");
    h5::read_scalar(file, format_path, format);
    if (format != checkpoint_format)
        throw FileError(fmt::format("is a checkpoint of format {}; this version reads format {}",
                                    format, checkpoint_format));
}

Contents contents_of(const std::string& path) {
    const h5::File file = h5::open_file(path, h5::Access::read);
    check_format(file.id());
    Contents contents;
    contents.header = read_header(file.id());
    check_header(contents.header);
    contents.header.species = read_species(file.id(), species_path, contents.header.n_discs);
    contents.sums = read_checksums(file.id());
    contents.samples = samples_of(file.id(), contents.sums);
    check_disc_data(contents);
    if (checksum_of_others(path, contents.sums.left_out()) != contents.sums.others)
        throw FileError("is damaged: bytes besides the data sets of discs do not have the checksum "
                        "they had when it was written");
    return contents;
}

/// Checks and reads the contents. Puts "is damaged: " before errors that do not begin with "is ".
Contents inspected_contents(const std::string& path) {
    try {
        return contents_of(path);
    } catch (const MachineError&) {
        throw; // a machine error: the file may be undamaged
    } catch (const FileError& error) {
        const std::string text = error.what();
        throw FileError(text.starts_with("is ") ? text : "is damaged: " + text);
    }
}

/// Replaces `contents` on every rank by rank 0's contents. **Collective.**
void broadcast(Contents& contents, const Communicator& communicator) {
    CheckpointHeader& header = contents.header;
    visit_header(header, [&](const char*, auto& value) { communicator.broadcast(value); });
    communicator.broadcast(header.box_height);
    communicator.broadcast(header.frame);
    communicator.broadcast(header.columns);
    communicator.broadcast(header.species);
    std::uint64_t n_data = contents.sums.data.size();
    communicator.broadcast(n_data);
    contents.sums.data.resize(n_data);
    for (DiscData& data : contents.sums.data) {
        communicator.broadcast(data.path);
        communicator.broadcast(data.rows);
        communicator.broadcast(data.bytes_per_row);
        communicator.broadcast(data.checksum);
    }
    communicator.broadcast(contents.samples.averages);
    communicator.broadcast(contents.samples.watched);
    communicator.broadcast(contents.samples.stop);
    communicator.broadcast(contents.samples.effects);
    communicator.broadcast(contents.samples.sums);
    for (const SampleColumn& column : sample_columns) {
        bool& is_there = contents.samples.*column.is_there;
        is_there = communicator.any(is_there);
    }
}

/// A checkpoint whose checksums are right, open on all ranks.
class WholeFile {
public:
    /// Throws CollectiveError on every rank if the file is damaged. **Collective.**
    WholeFile(const std::string& path, const Communicator& communicator)
        : path_(path), communicator_(communicator) {
        on_root(communicator_, path_, ExitCode::bad_input, [&] {
            refuse_old_format(path_);
            inspect_in_child_first([&] { contents = inspected_contents(path_); });
        });
        broadcast(contents, communicator_);
        on_all(communicator_, path_, ExitCode::bad_input, [] { require_free_files(); });
        on_all(communicator_, path_, ExitCode::bad_input,
               [&] { file_ = h5::SharedFile(path_, h5::Access::read, communicator_); });
        on_all(communicator_, path_, ExitCode::bad_input, [&] {
            for (const DiscData& data : contents.sums.data)
                datasets_.push_back(h5::open_checked(file_.id(), data.path));
        });
        check_numbers();
    }

    /// Reads rows of a data set, 8 bytes each, from row `begin` on. Not collective; throws
    /// FileError.
    template <class Number>
    void read(const std::string& path, std::span<Number> numbers, std::uint64_t begin,
              hid_t type) const {
        static_assert(sizeof(Number) == 8);
        for (std::size_t k = 0; k < datasets_.size(); ++k)
            if (contents.sums.data[k].path == path && !numbers.empty())
                h5::read_rows(datasets_[k].id(), {begin, begin + numbers.size()}, type,
                              numbers.data());
    }

    /// **Collective.**
    void close() {
        datasets_.clear();
        on_all(communicator_, path_, ExitCode::bad_input, [&] { file_.close(); });
    }

    Contents contents;

private:
    void check_numbers() {
        std::vector<StateHash> sums(datasets_.size());
        on_all(communicator_, path_, ExitCode::bad_input, [&] {
            for (std::size_t k = 0; k < sums.size(); ++k)
                sums[k] = share_of_checksum(datasets_[k].id(), contents.sums.data[k],
                                            communicator_);
        });
        sum_over(communicator_, sums);
        std::string names;
        for (std::size_t k = 0; k < sums.size(); ++k)
            if (sums[k] != contents.sums.data[k].checksum)
                names += (names.empty() ? "" : ", ") + contents.sums.data[k].path;
        on_root(communicator_, path_, ExitCode::bad_input, [&] {
            if (!names.empty())
                throw FileError("is damaged: these data sets do not have the checksum they had "
                                "when it was written: " +
                                names);
        });
    }

    std::string path_;
    const Communicator& communicator_;
    h5::SharedFile file_;
    std::vector<h5::Dataset> datasets_;
};

/// Unpacks discs piece by piece, so that each piece stays in cache. Throws FileError.
DiscStates read_discs(const WholeFile& file, const Slab& share) {
    DiscStates discs(share.size(), DiscState{});
    std::vector<std::uint64_t> numbers(std::min(rows_per_piece, share.size()));
    for (std::uint64_t begin = 0; begin < share.size(); begin += rows_per_piece) {
        const auto wanted = std::span(numbers).first(
            std::min(rows_per_piece, share.size() - begin));
        for (std::size_t i = 0; i < wanted.size(); ++i)
            discs[begin + i].id = share.begin + begin + i;
        for (const StateColumn& column : disc_columns) {
            file.read(path_of(column), wanted, share.begin + begin, type_of(column));
            for (std::size_t i = 0; i < wanted.size(); ++i) column.set(discs[begin + i], wanted[i]);
        }
    }
    return discs;
}

/// Reads the samples of the discs in `share`, if the file has any. Throws FileError.
std::vector<FirstPlace> read_places(const WholeFile& file, const Slab& share) {
    const StoredSamples& samples = file.contents.samples;
    if (!samples.have_first_places && !samples.have_images) return {};
    std::vector<FirstPlace> places(share.size());
    for (std::size_t i = 0; i < places.size(); ++i) places[i].id = share.begin + i;
    std::vector<double> numbers(share.size());
    for (const SampleColumn& column : sample_columns) {
        if (!(samples.*column.is_there)) continue;
        file.read(column.path, std::span(numbers), share.begin, H5T_NATIVE_DOUBLE);
        const double most = column.most *
                            (column.in_sides ? file.contents.header.box().longest() : 1);
        for (std::size_t i = 0; i < places.size(); ++i) {
            if (!(std::fabs(numbers[i]) <= most))
                throw FileError(std::string(column.path) + " holds what is no place");
            places[i].*column.field = numbers[i];
        }
    }
    return places;
}

StateHash hash_of(const Checkpoint& checkpoint) {
    StateHash hash = hash_of(checkpoint.discs);
    checkpoint.columns.for_each([&](SideColumn column) {
        for (std::size_t i = 0; i < checkpoint.discs.size(); ++i)
            hash += hash_of(column, checkpoint.discs[i].id, checkpoint.columns[column][i]);
    });
    return hash;
}

} // namespace

std::optional<CheckpointHeader> check_damage(const std::string& path,
                                             const Communicator& communicator) {
    std::uint64_t is_checkpoint = 0;
    on_root(communicator, path, ExitCode::bad_input, [&] {
        refuse_old_format(path);
        inspect_in_child_first([&] {
            // Checks the index here, before HDF5 opens the segments that it names
            static_cast<void>(read_checked_index(path, false));
            is_checkpoint = h5::has(h5::open_file(path, h5::Access::read).id(), run_path) ? 1 : 0;
        });
    });
    communicator.broadcast(is_checkpoint);
    if (is_checkpoint == 0) return std::nullopt;
    WholeFile file(path, communicator);
    file.close();
    return std::move(file.contents.header);
}

Checkpoint read_checkpoint(const std::string& path, const Communicator& communicator) {
    WholeFile file(path, communicator);
    Checkpoint checkpoint;
    checkpoint.header = file.contents.header;
    checkpoint.samples = file.contents.samples;
    const Slab share = slab_of_rank(communicator.rank(), checkpoint.header.n_discs,
                                    communicator.size());
    on_all(communicator, path, ExitCode::bad_input, [&] {
        checkpoint.discs = read_discs(file, share);
        checkpoint.header.columns.for_each([&](SideColumn column) {
            std::vector<double> numbers(share.size());
            file.read(path_of(column), std::span(numbers), share.begin, H5T_NATIVE_DOUBLE);
            checkpoint.columns.add(column, std::move(numbers));
        });
        checkpoint.samples.first_places = read_places(file, share);
    });
    file.close();
    StateHash hash = hash_of(checkpoint);
    sum_over(communicator, {&hash, 1});
    on_root(communicator, path, ExitCode::bad_input, [&] {
        if (to_string(hash) != checkpoint.header.state_hash)
            throw FileError("its discs do not have its state hash");
    });
    return checkpoint;
}

} // namespace carrom
