// SPDX-License-Identifier: BSD-3-Clause
// HDF5's C interface with errors that throw and handles that close themselves. Nothing outside this
// module sees it.
//
// A throw on one rank alone would leave the others waiting, so a collective call stands alone in
// the body of an `on_all` (on_all.hpp), which brings the ranks together again.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <hdf5.h>

#include "parallel/communicator.hpp"

namespace carrom::h5 {

/// Throws FileError with `what` and the cause that HDF5 gives.
[[noreturn]] void fail(const std::string& what);

/// Hands on what HDF5 has returned, or throws.
template <class Result> Result checked(Result result, const char* what) {
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

    /// What has been written must be closed with this: some failures show only here.
    void close(const char* what) {
        if (id_ >= 0) checked(close_function(std::exchange(id_, -1)), what);
    }

    /// Leaves the object open for good.
    void abandon() { id_ = -1; }

private:
    hid_t id_ = -1;
};

using File = Handle<H5Fclose>;
using Group = Handle<H5Gclose>;
using Dataset = Handle<H5Dclose>;
using Space = Handle<H5Sclose>;
using Type = Handle<H5Tclose>;
using Attribute = Handle<H5Aclose>;
using Properties = Handle<H5Pclose>;

Properties properties(hid_t kind);
/// For a new dataset, which is not to say when it was made: the same contents are the same bytes.
Properties dataset_creation();
/// The same for one that has its place in the file at once, and no numbers yet.
Properties allocated_creation();
/// Of one number where there are no dimensions.
Space space(std::span<const hsize_t> dimensions);

enum class Access { read, write };
File open_file(const std::string& path, Access access);

/// A file that ranks have open through MPI-IO, each to read or write rows of its own. Nothing
/// collective is called on one that has failed: unless it is closed, it stays open until the
/// program's end.
class SharedFile {
public:
    SharedFile() = default;
    /// **Collective.**
    SharedFile(const std::string& path, Access access, const Communicator& communicator);
    ~SharedFile() { file_.abandon(); }
    SharedFile(SharedFile&&) = default;
    SharedFile& operator=(SharedFile&&) = default;
    hid_t id() const { return file_.id(); }
    /// To be called once all ranks are known to be well. **Collective.**
    void close() { file_.close("cannot be closed"); }

private:
    File file_;
};

/// Whether there is something at an absolute path. HDF5 wants every group on the way to be asked
/// for.
bool has(hid_t file, const std::string& path);
/// Makes the groups on the way too.
Group create_group(hid_t parent, const char* name);
/// To be written to; what is to be read may be damaged: see checked_dataset.hpp.
Dataset open_dataset(hid_t parent, const char* name);

/// Attributes and scalars; texts are of fixed length, UTF-8.
void write_attribute(hid_t object, const char* name, const std::string& text);
void write_attribute(hid_t object, const char* name, std::span<const std::int32_t> numbers);
void write_attribute(hid_t object, const char* name, const std::vector<std::string>& words);
/// A text of any length, as h5py writes them: it takes others for bytes.
void write_any_length(hid_t object, const char* name, const std::string& text);
void write_text(hid_t parent, const char* name, const std::string& text);
/// Replaces a text by one as long.
void overwrite_text(hid_t parent, const char* name, const std::string& text);
std::string read_text(hid_t parent, const char* name);

/// A dataset of one value or one row of values for each of the numbers, written at once by this
/// process.
void write_whole(hid_t parent, const char* name, std::span<const hsize_t> dimensions, hid_t type,
                 const void* values);

/// Replaces all of a data set.
void overwrite(hid_t parent, const char* name, hid_t type, const void* values);
/// Reads a data set of one value.
void read_single(hid_t parent, const char* name, hid_t type, void* value);

template <class Number> hid_t type_of() {
    if constexpr (std::is_same_v<Number, double>)
        return H5T_NATIVE_DOUBLE;
    else if constexpr (std::is_same_v<Number, std::int64_t>)
        return H5T_NATIVE_INT64;
    else {
        static_assert(std::is_same_v<Number, std::uint64_t>);
        return H5T_NATIVE_UINT64;
    }
}
template <class Value> void write_scalar(hid_t parent, const char* name, const Value& value) {
    if constexpr (std::is_same_v<Value, std::string>)
        write_text(parent, name, value);
    else
        write_whole(parent, name, {}, type_of<Value>(), &value);
}
template <class Value> void read_scalar(hid_t parent, const char* name, Value& value) {
    if constexpr (std::is_same_v<Value, std::string>)
        value = read_text(parent, name);
    else
        read_single(parent, name, type_of<Value>(), &value);
}

/// The dimensions of a dataset.
std::vector<hsize_t> dimensions_of(hid_t dataset);

struct Rows {
    std::uint64_t begin = 0, end = 0;
};

/// Rows run along a data set's only axis, or along the second one where it has several.
std::uint64_t n_rows_of(hid_t dataset);

/// Rows, at least one, of a data set. Not collective: a rank's rows are one large piece of the
/// file, so there is nothing for MPI-IO to gather.
void read_rows(hid_t dataset, const Rows& rows, hid_t type, void* numbers);

/// Independent: each rank writes as it comes to it. Collective: all ranks write together, and
/// MPI-IO may hand the numbers to a few of them that write them in large pieces.
enum class Transfer { independent, collective };

/// This rank's rows of a data set. **Collective** if `transfer` is; a rank may have no rows then.
void write_rows(hid_t dataset, const Rows& rows, hid_t type, const void* numbers,
                Transfer transfer);

/// A new file where there is none, nor a symbolic link, of that name. Large data sets begin at
/// pages of 4096 bytes.
File create_empty_file(const std::string& path);

/// The same, filled by `build(file)` and closed.
template <class Build> void create_file(const std::string& path, const Build& build) {
    File file = create_empty_file(path);
    try {
        build(file.id());
        file.close("cannot be written");
    } catch (...) {
        file.abandon(); // closing would try to write again
        throw;
    }
}

} // namespace carrom::h5
