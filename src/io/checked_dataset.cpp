// SPDX-License-Identifier: BSD-3-Clause
#include "io/checked_dataset.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <initializer_list>

#include "io/files.hpp"

namespace carrom::h5 {

namespace {

constexpr std::size_t most_axes = 3;
constexpr hsize_t largest_chunk = hsize_t{1} << 24; ///< bytes; ours are of 2 MiB at most
constexpr hsize_t best_deflation = 1032;            ///< the most that deflate can make of a byte
constexpr std::uint64_t most_numbers = std::uint64_t{1} << 60;

bool is_one_of(hid_t type, std::initializer_list<hid_t> known) {
    return std::any_of(known.begin(), known.end(),
                       [type](hid_t other) { return H5Tequal(type, other) > 0; });
}

void check_type(hid_t type, const std::string& name) {
    const H5T_class_t kind = H5Tget_class(type);
    const bool is_known =
        (kind == H5T_FLOAT &&
         is_one_of(type, {H5T_IEEE_F64LE, H5T_IEEE_F32LE, H5T_IEEE_F64BE, H5T_IEEE_F32BE})) ||
        (kind == H5T_INTEGER && is_one_of(type, {H5T_STD_I64LE, H5T_STD_U64LE, H5T_STD_I64BE,
                                                 H5T_STD_U64BE, H5T_STD_I32LE, H5T_STD_I32BE})) ||
        (kind == H5T_STRING && H5Tis_variable_str(type) == 0);
    if (!is_known) throw FileError(name + " is of another type than this program writes");
}

/// The bytes of a chunk; 0 for a data set in one piece. `deflates`: whether its filters make bytes
/// fewer.
hsize_t check_layout(hid_t creation, std::size_t n_axes, const std::string& name, bool& deflates) {
    const H5D_layout_t layout = H5Pget_layout(creation);
    const int n_filters = H5Pget_nfilters(creation);
    bool is_ours = (layout == H5D_CONTIGUOUS || layout == H5D_CHUNKED) && n_filters >= 0 &&
                   n_filters <= 3 && H5Pget_external_count(creation) == 0;
    for (int k = 0; is_ours && k < n_filters; ++k) {
        unsigned flags = 0;
        std::size_t n_values = 0;
        const H5Z_filter_t filter = H5Pget_filter2(creation, static_cast<unsigned>(k), &flags,
                                                   &n_values, nullptr, 0, nullptr, nullptr);
        deflates |= filter == H5Z_FILTER_DEFLATE;
        is_ours = filter == H5Z_FILTER_DEFLATE || filter == H5Z_FILTER_SHUFFLE ||
                  filter == H5Z_FILTER_FLETCHER32;
    }
    if (!is_ours) throw FileError(name + " is stored in another way than this program does");
    if (layout == H5D_CONTIGUOUS) return 0;
    std::array<hsize_t, most_axes> boundaries{};
    if (H5Pget_chunk(creation, most_axes, boundaries.data()) != static_cast<int>(n_axes))
        throw FileError(name + " has chunks of another shape");
    hsize_t bytes = 8;
    for (std::size_t k = 0; k < n_axes; ++k)
        bytes = std::min(boundaries[k], largest_chunk + 1) * std::min(bytes, largest_chunk + 1);
    return bytes;
}

/// The product of the sizes, which may be anything.
std::uint64_t count(const std::vector<hsize_t>& sizes) {
    std::uint64_t product = 1;
    for (const hsize_t size : sizes) {
        if (size > most_numbers / std::max<std::uint64_t>(1, product)) return most_numbers;
        product *= size;
    }
    return product;
}

/// A recording's numbers stand in segments beside it, each as large as they need.
void check_virtual(const Dataset& dataset, hid_t creation, const std::string& name,
                   std::uint64_t n_numbers, std::size_t bytes_per_number) {
    std::size_t n_parts = 0;
    checked(H5Pget_virtual_count(creation, &n_parts), name.c_str());
    std::string own(4096, '\0');
    checked(H5Fget_name(dataset.id(), own.data(), own.size()), name.c_str());
    const std::filesystem::path folder = std::filesystem::path(own.c_str()).parent_path();
    std::uint64_t n_found = 0;
    for (std::size_t k = 0; k < n_parts; ++k) {
        std::string file(4096, '\0');
        checked(H5Pget_virtual_filename(creation, k, file.data(), file.size()), name.c_str());
        const std::filesystem::path part = file.c_str();
        const Space space(checked(H5Pget_virtual_srcspace(creation, k), name.c_str()));
        const auto n = static_cast<std::uint64_t>(H5Sget_select_npoints(space.id()));
        std::error_code error;
        const std::uintmax_t size = std::filesystem::file_size(folder / part, error);
        if (part.is_absolute() || *part.begin() == ".." || error || n > size / bytes_per_number)
            throw FileError(name + " has a part that is not there: " + part.string());
        n_found += n;
    }
    if (n_found != n_numbers) throw FileError(name + " has other parts than this program writes");
}

} // namespace

Dataset open_checked(hid_t parent, const std::string& name) {
    Dataset dataset = open_dataset(parent, name.c_str());
    const Type type(checked(H5Dget_type(dataset.id()), name.c_str()));
    check_type(type.id(), name);
    const std::vector<hsize_t> sizes = dimensions_of(dataset.id());
    if (sizes.size() > most_axes) throw FileError(name + " has more axes than this program writes");
    const Properties creation(checked(H5Dget_create_plist(dataset.id()), name.c_str()));
    if (H5Pget_layout(creation.id()) == H5D_VIRTUAL) {
        check_virtual(dataset, creation.id(), name, count(sizes), H5Tget_size(type.id()));
        return dataset;
    }
    bool deflates = false;
    if (check_layout(creation.id(), sizes.size(), name, deflates) > largest_chunk)
        throw FileError(name + " has larger chunks than this program writes");
    hsize_t room = 0;
    const File file(checked(H5Iget_file_id(dataset.id()), name.c_str()));
    checked(H5Fget_filesize(file.id(), &room), "its size cannot be seen");
    if (deflates) room *= best_deflation;
    if (count(sizes) > room / std::max<std::size_t>(1, H5Tget_size(type.id())))
        throw FileError(name + " claims more than the file has room for");
    return dataset;
}

Dataset open_checked(hid_t parent, const std::string& name, const Shape& shape) {
    Dataset dataset = open_checked(parent, name);
    const std::vector<hsize_t> sizes = dimensions_of(dataset.id());
    const bool is_right = std::equal(
        shape.begin(), shape.end(), sizes.begin(), sizes.end(),
        [](std::optional<hsize_t> wanted, hsize_t size) { return !wanted || *wanted == size; });
    if (!is_right) throw FileError(name + " has another shape than this program writes");
    return dataset;
}

} // namespace carrom::h5
