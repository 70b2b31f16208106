// SPDX-License-Identifier: BSD-3-Clause
// HDF5's C interface, with exceptions for errors and handles that close themselves. Only this
// module uses it.
//
// If only one rank threw, the others would wait for it. So the body of an `on_all` (files.hpp)
// contains at most one collective call, and `on_all` throws on every rank.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <hdf5.h>

#include "parallel/communicator.hpp"

namespace carrom::h5 {

/// Throws FileError with `what` and the cause that HDF5 gives.
[[noreturn]] void fail(std::string_view what);

/// Returns the result of an HDF5 call, or throws if the call has failed.
template <class Result> Result checked(Result result, std::string_view what) {
    if (result < 0) fail(what);
    return result;
}

/// Owns one HDF5 identifier.
template <herr_t (*close_function)(hid_t)> class Handle {
public:
    Handle() = default;
    explicit Handle(hid_t id) : id_(id) {}
    ~Handle() {
        if (id_ >= 0) close_function(id_);
    }
    Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)) {}
    Handle& operator=(Handle&& other) noexcept {
        std::swap(id_, other.id_);
        return *this;
    }

    hid_t id() const { return id_; }

    /// Closes the object. Call it for objects that have been written to, because some failures
    /// appear only here.
    void close(std::string_view what) {
        if (id_ >= 0) checked(close_function(std::exchange(id_, -1)), what);
    }

    /// Releases the identifier without closing the object.
    void abandon() { id_ = -1; }

private:
    hid_t id_ = -1;
};

using File = Handle<H5Fclose>;
using Group = Handle<H5Gclose>;
using Dataset = Handle<H5Dclose>;
using Object = Handle<H5Oclose>;
using Space = Handle<H5Sclose>;
using Type = Handle<H5Tclose>;
using Attribute = Handle<H5Aclose>;
using Properties = Handle<H5Pclose>;

Properties properties(hid_t kind);
/// Calls a function H5Pset_..., which fails only if memory runs out.
template <class Set, class... Values>
void set(const Properties& list, const Set& set_values, Values... values) {
    checked(set_values(list.id(), values...), "cannot set a property");
}
/// Properties of a new data set without a time stamp, so that equal contents give equal bytes.
Properties dataset_creation();
/// Properties of a new data set whose space is allocated before any numbers are written.
Properties allocated_creation();
/// A data space of these dimensions; a single number if `dimensions` is empty.
Space space(std::span<const hsize_t> dimensions);
/// Selects `count` numbers along each axis from `start` on.
void select(const Space& space, std::span<const hsize_t> start, std::span<const hsize_t> count);

enum class Access { read, write };
/// Opens a file. If it is opened for reading and joins other files, these must be plain files below
/// its folder.
File open_file(const std::string& path, Access access);
/// Opens a file without checking the files that it joins.
File open_alone(const std::string& path, Access access);

/// A file that all ranks open together through MPI-IO; each rank reads or writes its own rows.
/// After a failure no collective function may be called for it. So unless it has been closed
/// before, it stays open until the program ends.
class SharedFile {
public:
    SharedFile() = default;
    /// **Collective.**
    SharedFile(const std::string& path, Access access, const Communicator& communicator);
    ~SharedFile() { file_.abandon(); }
    SharedFile(SharedFile&&) = default;
    SharedFile& operator=(SharedFile&&) = default;
    hid_t id() const { return file_.id(); }
    /// Call it when all ranks are known to have succeeded. **Collective.**
    void close() { file_.close("cannot be closed"); }

private:
    File file_;
};

/// Whether an object exists at an absolute path. Every group on the way is tested, because HDF5
/// fails if one is missing.
bool has(hid_t file, const std::string& path);
/// Makes a group, and the missing groups on its path.
Group create_group(hid_t parent, const std::string& name);
Dataset create_dataset(hid_t parent, const std::string& name, hid_t type,
                       std::span<const hsize_t> dimensions, const Properties& creation);
/// Opens a data set for writing. For reading see checked_dataset.hpp, because the data set may be
/// damaged.
Dataset open_dataset(hid_t parent, const std::string& name);
/// The type of the numbers or the text in a data set.
Type stored_type(hid_t dataset);

inline hid_t type_of(double) { return H5T_NATIVE_DOUBLE; }
inline hid_t type_of(std::int32_t) { return H5T_NATIVE_INT32; }
inline hid_t type_of(std::int64_t) { return H5T_NATIVE_INT64; }
inline hid_t type_of(std::uint64_t) { return H5T_NATIVE_UINT64; }

/// Writes an attribute: a UTF-8 text of fixed length, a list of numbers, or a list of texts.
void write_attribute(hid_t object, const std::string& name, const std::string& text);
void write_attribute(hid_t object, const std::string& name, std::span<const std::int32_t> numbers);
void write_attribute(hid_t object, const std::string& name, const std::vector<std::string>& words);
/// Writes a string of variable length; h5py reads strings of fixed length as bytes.
void write_any_length(hid_t object, const std::string& name, const std::string& text);

/// Creates a data set and writes all of it from this process; one value if `dimensions` is empty.
void write_whole(hid_t parent, const std::string& name, std::span<const hsize_t> dimensions,
                 hid_t type, const void* values);
template <class Numbers>
void write_column(hid_t parent, const std::string& name, const Numbers& numbers) {
    const hsize_t n = numbers.size();
    write_whole(parent, name, {&n, 1}, type_of(typename Numbers::value_type{}), numbers.data());
}
template <class Number>
void write_scalar(hid_t parent, const std::string& name, const Number& number) {
    write_whole(parent, name, {}, type_of(number), &number);
}
void write_scalar(hid_t parent, const std::string& name, const std::string& text);

/// Replaces one value, or a text by another one of the same length.
void overwrite(hid_t parent, const std::string& name, std::uint64_t number);
void overwrite(hid_t parent, const std::string& name, const std::string& text);

/// Reads one value.
void read_single(hid_t parent, const std::string& name, hid_t type, void* value);
template <class Number> void read_scalar(hid_t parent, const std::string& name, Number& number) {
    read_single(parent, name, type_of(number), &number);
}
void read_scalar(hid_t parent, const std::string& name, std::string& text);

/// The dimensions of a dataset.
std::vector<hsize_t> dimensions_of(hid_t dataset);

/// A range of rows. Rows are along the data set's only axis, or along its second axis if the first
/// one counts frames.
struct RowRange {
    std::uint64_t begin = 0, end = 0, frame = 0;
};

std::uint64_t n_rows_of(hid_t dataset);

/// Reads rows, at least one, of a data set. Not collective, because a rank's rows are one large
/// piece of the file, so MPI-IO has nothing to gather.
void read_rows(hid_t dataset, const RowRange& rows, hid_t type, void* numbers);

/// Independent: each rank writes when it is ready. Collective: all ranks write together, and MPI-IO
/// may let a few of them write large pieces for all.
enum class Transfer { independent, collective };

/// Writes this rank's rows, if any, of a data set. **Collective** if `transfer` is collective.
void write_rows(hid_t dataset, const RowRange& rows, hid_t type, const void* numbers,
                Transfer transfer);

/// Makes a file and calls `build(file)` to fill it. Throws FileError if a file or a symbolic link
/// of that name exists. Data sets of at least 64 KiB begin at multiples of 4096 bytes.
void create_file(const std::string& path, const std::function<void(hid_t file)>& build);

} // namespace carrom::h5
