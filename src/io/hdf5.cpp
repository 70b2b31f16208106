// SPDX-License-Identifier: BSD-3-Clause
#include "io/hdf5.hpp"

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <string_view>

#include <fcntl.h>

#include "io/checked_dataset.hpp"
#include "io/files.hpp"
#include "io/seal.hpp"
#include "io/start_io.hpp"
#include "parallel/native.hpp"

namespace carrom {

void start_io() {
    std::signal(SIGXFSZ, SIG_IGN);
    // HDF5 must not lock files: readers open growing recordings, and runs have their own lock.
    setenv("HDF5_USE_FILE_LOCKING", "FALSE", 1);
    H5dont_atexit();
    H5open(); // before MPI starts, so that HDF5 does not register an action for MPI's end
    H5Lunregister(H5L_TYPE_EXTERNAL); // HDF5 must not follow links into other files
    H5PLset_loading_state(0);         // HDF5 must not load libraries of filters
}

std::string hdf5_version() {
    unsigned major = 0, minor = 0, release = 0;
    H5get_libversion(&major, &minor, &release);
    return std::to_string(major) + '.' + std::to_string(minor) + '.' + std::to_string(release);
}

} // namespace carrom

namespace carrom::h5 {

namespace {

// Longer than any scene, which has at most 2^26 characters
constexpr std::size_t longest_text = std::size_t{1} << 28;
constexpr unsigned most_links = 64; // a group's header contains at most this many links

/// Collects the two innermost entries of HDF5's error stack, because these contain the error
/// message of the operating system.
herr_t take_text(unsigned number, const H5E_error2_t* error, void* text) {
    auto& all = *static_cast<std::string*>(text);
    if (number < 2 && error->desc != nullptr && *error->desc != '\0')
        all += std::string(all.empty() ? "" : "; ") + error->desc;
    std::replace(all.begin(), all.end(), '\n', ' '); // HDF5 writes times of day with a line break
    return 0;
}

/// Stops HDF5 from printing its error stack to standard error on every rank.
void be_quiet() { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }

/// Time stamps are left out, so that equal contents give equal bytes.
void leave_out_times(const Properties& creation) { set(creation, H5Pset_obj_track_times, false); }

/// Groups that keep the order of their members have HDF5's newer format, whose metadata HDF5
/// protects by checksums.
void as_checked_group(const Properties& creation) {
    leave_out_times(creation);
    set(creation, H5Pset_link_creation_order, unsigned{H5P_CRT_ORDER_TRACKED});
    set(creation, H5Pset_link_phase_change, most_links, most_links / 2);
}

File opened(const std::string& path, Access access, hid_t list) {
    const unsigned flags = access == Access::read ? H5F_ACC_RDONLY : H5F_ACC_RDWR;
    return File(checked(H5Fopen(path.c_str(), flags, list), "cannot be opened"));
}

Properties with_groups_on_the_way() {
    Properties links = properties(H5P_LINK_CREATE);
    set(links, H5Pset_create_intermediate_group, 1u);
    return links;
}

Type text_type(std::size_t length) {
    Type type(checked(H5Tcopy(H5T_C_S1), "cannot make a text type"));
    checked(H5Tset_size(type.id(), std::max<std::size_t>(1, length)), "cannot size a text type");
    checked(H5Tset_strpad(type.id(), H5T_STR_NULLPAD), "cannot pad a text type");
    checked(H5Tset_cset(type.id(), H5T_CSET_UTF8), "cannot make a text type UTF-8");
    return type;
}

void write_attribute(hid_t object, const std::string& name, hid_t type, const Space& shape,
                     const void* values) {
    const Attribute attribute(checked(
        H5Acreate2(object, name.c_str(), type, shape.id(), H5P_DEFAULT, H5P_DEFAULT), name));
    checked(H5Awrite(attribute.id(), type, values), name);
}

void write_and_close(Dataset dataset, const std::string& name, hid_t type, const void* values) {
    checked(H5Dwrite(dataset.id(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values), name);
    dataset.close(name);
}

/// Data spaces that select rows of a data set, and contiguous memory for these rows.
struct Selection {
    Space memory, file;
};

Selection select(hid_t dataset, const RowRange& rows) {
    std::vector<hsize_t> count = dimensions_of(dataset), start(count.size(), 0);
    if (count.empty()) throw FileError("a data set has no rows");
    const std::size_t axis = count.size() > 1 ? 1 : 0;
    if (axis == 1) start[0] = rows.frame, count[0] = 1;
    start[axis] = rows.begin;
    count[axis] = rows.end - rows.begin;
    Selection selected{space(count),
                       Space(checked(H5Dget_space(dataset), "cannot inspect a dataset"))};
    if (rows.begin == rows.end) {
        checked(H5Sselect_none(selected.memory.id()), "cannot select no rows");
        checked(H5Sselect_none(selected.file.id()), "cannot select no rows");
        return selected;
    }
    select(selected.file, start, count);
    return selected;
}

} // namespace

void fail(std::string_view what) {
    std::string text;
    H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, take_text, &text);
    throw FileError(std::string(what) + (text.empty() ? "" : ": " + text));
}

Properties properties(hid_t kind) {
    return Properties(checked(H5Pcreate(kind), "cannot make a property list"));
}

Properties dataset_creation() {
    Properties creation = properties(H5P_DATASET_CREATE);
    leave_out_times(creation);
    // selects the newer format with checksums, as for groups
    set(creation, H5Pset_attr_creation_order, unsigned{H5P_CRT_ORDER_TRACKED});
    return creation;
}

Properties allocated_creation() {
    Properties creation = dataset_creation();
    set(creation, H5Pset_alloc_time, H5D_ALLOC_TIME_EARLY);
    set(creation, H5Pset_fill_time, H5D_FILL_TIME_NEVER);
    return creation;
}

Space space(std::span<const hsize_t> dimensions) {
    return Space(
        checked(H5Screate_simple(static_cast<int>(dimensions.size()), dimensions.data(), nullptr),
                "cannot make a data space"));
}

void select(const Space& space, std::span<const hsize_t> start, std::span<const hsize_t> count) {
    checked(H5Sselect_hyperslab(space.id(), H5S_SELECT_SET, start.data(), nullptr, count.data(),
                                nullptr),
            "cannot select rows");
}

void create_file(const std::string& path, const std::function<void(hid_t file)>& build) {
    be_quiet();
    const Properties creation = properties(H5P_FILE_CREATE), access = properties(H5P_FILE_ACCESS);
    as_checked_group(creation);
    set(access, H5Pset_alignment, hsize_t{1} << 16, hsize_t{1} << 12);
    File file(checked(H5Fcreate(path.c_str(), H5F_ACC_EXCL, creation.id(), access.id()),
                      "cannot be created"));
    try {
        build(file.id());
        file.close("cannot be written");
    } catch (...) {
        file.abandon(); // closing would try to write again
        throw;
    }
}

File open_alone(const std::string& path, Access access) {
    be_quiet();
    const Descriptor plain(path, O_RDONLY); // fails for pipes; HDF5 would wait for the other end
    if (access == Access::read && !check_seal(path)) check_heaps(path);
    if (H5Fis_hdf5(path.c_str()) == 0)
        throw FileError(
            "is no HDF5 file, so none that carrom has written; carrom-import takes other formats");
    try {
        return opened(path, access, H5P_DEFAULT);
    } catch (const FileError& error) {
        if (std::string_view(error.what()).find("truncated file") == std::string_view::npos) throw;
        throw FileError("is cut short, or its first bytes are damaged");
    }
}

File open_file(const std::string& path, Access access) {
    File file = open_alone(path, access);
    if (access == Access::read) refuse_other_files(file.id(), path);
    return file;
}

SharedFile::SharedFile(const std::string& path, Access access, const Communicator& communicator) {
    if (native(communicator) == MPI_COMM_NULL) { // the program runs without MPI
        file_ = open_file(path, access);
        return;
    }
    be_quiet();
    const Properties list = properties(H5P_FILE_ACCESS);
    checked(H5Pset_fapl_mpio(list.id(), native(communicator), MPI_INFO_NULL),
            "cannot choose MPI-IO");
    set(list, H5Pset_all_coll_metadata_ops, true);
    file_ = opened(path, access, list.id());
}

bool has(hid_t file, const std::string& path) {
    for (std::size_t end = path.find('/', 1);; end = path.find('/', end + 1)) {
        // An error must not count as a missing object: in some damaged groups, HDF5 finds a link
        // only when it is called a second time.
        const std::string part = path.substr(0, end);
        if (checked(H5Lexists(file, part.c_str(), H5P_DEFAULT), part) == 0) return false;
        if (end == std::string::npos) return true;
    }
}

Group create_group(hid_t parent, const std::string& name) {
    const Properties creation = properties(H5P_GROUP_CREATE);
    as_checked_group(creation);
    return Group(checked(
        H5Gcreate2(parent, name.c_str(), with_groups_on_the_way().id(), creation.id(), H5P_DEFAULT),
        name));
}

Dataset create_dataset(hid_t parent, const std::string& name, hid_t type,
                       std::span<const hsize_t> dimensions, const Properties& creation) {
    return Dataset(checked(H5Dcreate2(parent, name.c_str(), type, space(dimensions).id(),
                                      with_groups_on_the_way().id(), creation.id(), H5P_DEFAULT),
                           name));
}

Dataset open_dataset(hid_t parent, const std::string& name) {
    return Dataset(checked(H5Dopen2(parent, name.c_str(), H5P_DEFAULT), name));
}

Type stored_type(hid_t dataset) {
    return Type(checked(H5Dget_type(dataset), "cannot inspect a dataset"));
}

void write_attribute(hid_t object, const std::string& name, const std::string& text) {
    write_attribute(object, name, text_type(text.size()).id(), space({}), text.c_str());
}

void write_attribute(hid_t object, const std::string& name, std::span<const std::int32_t> numbers) {
    const hsize_t length = numbers.size();
    write_attribute(object, name, H5T_NATIVE_INT32, space({&length, 1}), numbers.data());
}

void write_attribute(hid_t object, const std::string& name, const std::vector<std::string>& words) {
    std::size_t longest = 1;
    for (const std::string& word : words) longest = std::max(longest, word.size());
    std::string letters;
    for (std::string word : words) {
        word.resize(longest);
        letters += word;
    }
    const hsize_t length = words.size();
    write_attribute(object, name, text_type(longest).id(), space({&length, 1}), letters.data());
}

void write_any_length(hid_t object, const std::string& name, const std::string& text) {
    const char* const letters = text.c_str();
    write_attribute(object, name, text_type(H5T_VARIABLE).id(), space({}), &letters);
}

/// Also closes the data set, because HDF5 writes small data to the file only then.
void write_whole(hid_t parent, const std::string& name, std::span<const hsize_t> dimensions,
                 hid_t type, const void* values) {
    write_and_close(create_dataset(parent, name, type, dimensions, dataset_creation()), name, type,
                    values);
}

void write_scalar(hid_t parent, const std::string& name, const std::string& text) {
    write_whole(parent, name, {}, text_type(text.size()).id(), text.c_str());
}

void overwrite(hid_t parent, const std::string& name, std::uint64_t number) {
    write_and_close(open_dataset(parent, name), name, type_of(number), &number);
}

void overwrite(hid_t parent, const std::string& name, const std::string& text) {
    write_and_close(open_dataset(parent, name), name, text_type(text.size()).id(), text.c_str());
}

void read_single(hid_t parent, const std::string& name, hid_t type, void* value) {
    const Dataset dataset = open_checked(parent, name, Shape{});
    if (H5Tget_class(stored_type(dataset.id()).id()) != H5Tget_class(type))
        throw FileError(name + " is of another type than this program writes");
    checked(H5Dread(dataset.id(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, value), name);
}

void read_scalar(hid_t parent, const std::string& name, std::string& text) {
    const Type type = stored_type(open_checked(parent, name).id());
    if (H5Tget_class(type.id()) != H5T_STRING || H5Tget_size(type.id()) > longest_text)
        throw FileError(name + " is not a text of ours");
    text.resize(H5Tget_size(type.id()));
    read_single(parent, name, type.id(), text.data());
    text.resize(text.find_last_not_of('\0') + 1); // removes the padding
}

std::vector<hsize_t> dimensions_of(hid_t dataset) {
    const Space shape(checked(H5Dget_space(dataset), "cannot inspect a dataset"));
    std::vector<hsize_t> dimensions(static_cast<std::size_t>(
        checked(H5Sget_simple_extent_ndims(shape.id()), "cannot inspect a dataset")));
    checked(H5Sget_simple_extent_dims(shape.id(), dimensions.data(), nullptr),
            "cannot inspect a dataset");
    return dimensions;
}

std::uint64_t n_rows_of(hid_t dataset) {
    const std::vector<hsize_t> sizes = dimensions_of(dataset);
    return sizes.empty() ? 0 : sizes[sizes.size() > 1 ? 1 : 0];
}

void read_rows(hid_t dataset, const RowRange& rows, hid_t type, void* numbers) {
    const Selection selected = select(dataset, rows);
    checked(H5Dread(dataset, type, selected.memory.id(), selected.file.id(), H5P_DEFAULT, numbers),
            "cannot be read");
}

void write_rows(hid_t dataset, const RowRange& rows, hid_t type, const void* numbers,
                Transfer transfer) {
    const Selection selected = select(dataset, rows);
    const Properties list = properties(H5P_DATASET_XFER);
    set(list, H5Pset_dxpl_mpio,
        transfer == Transfer::collective ? H5FD_MPIO_COLLECTIVE : H5FD_MPIO_INDEPENDENT);
    checked(H5Dwrite(dataset, type, selected.memory.id(), selected.file.id(), list.id(), numbers),
            "cannot be written");
}

} // namespace carrom::h5
