// SPDX-License-Identifier: BSD-3-Clause
#include "io/checked_dataset.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <set>
#include <string_view>

#include <fcntl.h>

#include <fmt/format.h>

#include "io/files.hpp"
#include "io/seal.hpp"

namespace carrom::h5 {

namespace {

constexpr std::size_t longest_path = 4096;
constexpr double largest_chunk = 256 << 20;
constexpr double largest_ratio = 1100; ///< deflate expands a byte to at most 1032 bytes

bool is_known_type(hid_t type) {
    const H5T_class_t kind = H5Tget_class(type);
    const std::size_t size = H5Tget_size(type);
    return ((kind == H5T_FLOAT || kind == H5T_INTEGER) && (size == 4 || size == 8)) ||
           (kind == H5T_STRING && H5Tis_variable_str(type) == 0);
}

/// Throws unless all segments of a recording, the files that contain its numbers, exist, lie below
/// the recording's folder, are as large as their rows need, and together have all rows.
void check_segments_of(const Dataset& dataset, hid_t creation, const std::string& name,
                       std::size_t bytes_per_number) {
    std::size_t n_parts = 0;
    checked(H5Pget_virtual_count(creation, &n_parts), name);
    std::string own(longest_path, '\0');
    checked(H5Fget_name(dataset.id(), own.data(), own.size()), name);
    const std::filesystem::path folder = std::filesystem::path(own.c_str()).parent_path();
    hssize_t n_found = 0;
    for (std::size_t k = 0; k < n_parts; ++k) {
        std::string file(longest_path, '\0');
        checked(H5Pget_virtual_filename(creation, k, file.data(), file.size()), name);
        const std::filesystem::path part = file.c_str();
        const Space space(checked(H5Pget_virtual_srcspace(creation, k), name));
        const hssize_t n = H5Sget_select_npoints(space.id());
        std::error_code error;
        const std::uintmax_t size = std::filesystem::file_size(folder / part, error);
        if (part.is_absolute() || *part.begin() == ".." || error ||
            static_cast<std::uintmax_t>(n) > size / bytes_per_number)
            throw FileError(name + " has a part that is not there: " + part.string());
        n_found += n;
    }
    const Space whole(checked(H5Dget_space(dataset.id()), name));
    if (n_found != H5Sget_simple_extent_npoints(whole.id()))
        throw FileError(name + " has other parts than this program writes");
}

/// Throws if chunks are too large, because HDF5 allocates a whole chunk to read a part of it.
void check_chunk_of(hid_t creation, const std::string& name, std::size_t bytes_per_number) {
    std::array<hsize_t, H5S_MAX_RANK> sizes{};
    const int rank = checked(H5Pget_chunk(creation, H5S_MAX_RANK, sizes.data()), name);
    double bytes = static_cast<double>(bytes_per_number);
    for (int k = 0; k < rank; ++k) bytes *= static_cast<double>(sizes[static_cast<std::size_t>(k)]);
    if (bytes > largest_chunk) throw FileError(name + " has larger chunks than 256 MiB");
}

/// Largest number of links, and deepest nesting of groups. Carrom's files have some dozens of
/// links, or one for each column.
constexpr std::size_t most_objects = 100000, deepest_group = 16;

/// Returns the result of a call. Throws FileError "is damaged" if the call has failed.
template <class Result> Result sound(Result result, const std::string& name) {
    return checked(result, "is damaged: " + name);
}

/// Adds the names of the files that a virtual data set joins; throws if it has external storage.
void add_parts_of(hid_t dataset, const std::string& name, std::set<std::string>& parts) {
    const Properties creation(sound(H5Dget_create_plist(dataset), name));
    if (H5Pget_external_count(creation.id()) != 0)
        throw FileError(name + " has its numbers in a file of another kind, which is not opened");
    if (H5Pget_layout(creation.id()) != H5D_VIRTUAL) return;
    std::size_t n_parts = 0;
    sound(H5Pget_virtual_count(creation.id(), &n_parts), name);
    for (std::size_t k = 0; k < n_parts; ++k) {
        std::string file(longest_path, '\0');
        sound(H5Pget_virtual_filename(creation.id(), k, file.data(), file.size()), name);
        parts.insert(file.c_str());
    }
}

/// The names of all files that virtual data sets in `file` join. A loop over a list of
/// groups replaces recursion, so that the stack does not grow with the file. Soft links are
/// skipped, because their targets are also found through hard links.
std::set<std::string> parts_named_in(hid_t file) {
    std::set<std::string> parts;
    struct Waiting {
        std::string path;
        std::size_t depth;
    };
    std::vector<Waiting> groups = {{"/", 0}};
    for (std::size_t n_objects = 0; !groups.empty();) {
        const Waiting next = std::move(groups.back());
        groups.pop_back();
        const Group group(sound(H5Gopen2(file, next.path.c_str(), H5P_DEFAULT), next.path));
        H5G_info_t all{};
        sound(H5Gget_info(group.id(), &all), next.path);
        n_objects += all.nlinks;
        if (next.depth > deepest_group || n_objects > most_objects)
            throw FileError("has more groups and data sets than this program writes");
        for (hsize_t k = 0; k < all.nlinks; ++k) {
            const std::string name = name_of_link(group.id(), k), path = next.path + name;
            H5L_info_t link{};
            sound(H5Lget_info(group.id(), name.c_str(), &link, H5P_DEFAULT), path);
            if (link.type == H5L_TYPE_SOFT) continue;
            if (link.type != H5L_TYPE_HARD) throw FileError(path + " is a link to another file");
            const Object object(sound(H5Oopen(group.id(), name.c_str(), H5P_DEFAULT), path));
            const H5I_type_t kind = H5Iget_type(object.id());
            if (kind == H5I_DATASET) add_parts_of(object.id(), path, parts);
            if (kind == H5I_GROUP) groups.push_back({path + '/', next.depth + 1});
        }
    }
    return parts;
}

} // namespace

std::string name_of_link(hid_t group, hsize_t number) {
    std::string name(longest_path, '\0');
    const ssize_t length = checked(H5Lget_name_by_idx(group, ".", H5_INDEX_NAME, H5_ITER_INC,
                                                      number, name.data(), name.size(),
                                                      H5P_DEFAULT),
                                   "is damaged: a name cannot be read");
    if (static_cast<std::size_t>(length) >= name.size()) throw FileError("has a name too long");
    name.resize(static_cast<std::size_t>(length));
    return name;
}

void refuse_other_files(hid_t file, const std::string& path) {
    for (const std::string& name : parts_named_in(file)) {
        const std::filesystem::path relative = name;
        const bool leads_out = relative.is_absolute() ||
                               std::find(relative.begin(), relative.end(), "..") != relative.end();
        if (leads_out) throw FileError(name + " is named as a part, and is not below its folder");
        const std::string part = (std::filesystem::path(folder_of(path)) / relative).string();
        if (std::error_code error; !std::filesystem::exists(part, error) && !error)
            continue; // a missing part is reported by the function that needs it
        try {
            check_heaps(part); // fails unless the part is a plain file
            const File opened(sound(H5Fopen(part.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), name));
            if (!parts_named_in(opened.id()).empty())
                throw FileError("has numbers in further files");
        } catch (const MachineError&) {
            throw;
        } catch (const FileError& error) {
            const bool is_damaged = std::string_view(error.what()).starts_with("is damaged");
            throw FileError(fmt::format("its part {}: {}", name,
                                        is_damaged ? "its structure is damaged" : error.what()));
        }
    }
}

void check_storage(const Dataset& dataset, const std::string& name) {
    const Properties creation(checked(H5Dget_create_plist(dataset.id()), name));
    // the parts of a virtual data set have already been checked
    if (H5Pget_layout(creation.id()) == H5D_VIRTUAL) return;
    const Space whole(checked(H5Dget_space(dataset.id()), name));
    const auto bytes = static_cast<double>(H5Sget_simple_extent_npoints(whole.id())) *
                       static_cast<double>(H5Tget_size(stored_type(dataset.id()).id()));
    if (bytes > largest_ratio * static_cast<double>(H5Dget_storage_size(dataset.id())))
        throw FileError(name + " has fewer bytes than its size says");
}

Dataset open_checked(hid_t parent, const std::string& name, const std::optional<Shape>& shape) {
    Dataset dataset = open_dataset(parent, name);
    const Type type = stored_type(dataset.id());
    const Properties creation(checked(H5Dget_create_plist(dataset.id()), name));
    if (!is_known_type(type.id()) || H5Pget_external_count(creation.id()) != 0)
        throw FileError(name + " is of another type than this program writes");
    if (H5Pget_layout(creation.id()) == H5D_VIRTUAL)
        check_segments_of(dataset, creation.id(), name, H5Tget_size(type.id()));
    if (H5Pget_layout(creation.id()) == H5D_CHUNKED)
        check_chunk_of(creation.id(), name, H5Tget_size(type.id()));
    const auto is_right = [](std::optional<hsize_t> wanted, hsize_t size) {
        return !wanted || *wanted == size;
    };
    const std::vector<hsize_t> sizes = dimensions_of(dataset.id());
    if (shape && !std::equal(shape->begin(), shape->end(), sizes.begin(), sizes.end(), is_right))
        throw FileError(name + " has another shape than this program writes");
    return dataset;
}

std::uint64_t count_up_to(hid_t file, const std::string& path, std::int64_t last) {
    const Dataset dataset = open_checked(file, path, Shape{std::nullopt});
    std::uint64_t low = 0, high = n_rows_of(dataset.id());
    while (low < high) { // bisection, because a log of collisions may have billions of rows
        const std::uint64_t middle = low + (high - low) / 2;
        std::int64_t number = 0;
        read_rows(dataset.id(), {middle, middle + 1}, H5T_NATIVE_INT64, &number);
        number <= last ? low = middle + 1 : high = middle;
    }
    return low;
}

} // namespace carrom::h5
