// SPDX-License-Identifier: BSD-3-Clause
#include "io/read_columns.hpp"

#include <optional>

#include "io/checked_dataset.hpp"

namespace carrom {

hsize_t length_of(hid_t file, const std::string& path) {
    return h5::dimensions_of(h5::open_checked(file, path, {std::nullopt}).id()).front();
}

std::vector<std::int64_t> read_numbers(hid_t file, const std::string& path) {
    const h5::Dataset dataset = h5::open_checked(file, path, {std::nullopt});
    std::vector<std::int64_t> numbers(h5::dimensions_of(dataset.id()).front());
    h5::checked(
        H5Dread(dataset.id(), H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data()),
        path.c_str());
    return numbers;
}

hsize_t count_up_to(hid_t file, const std::string& path, std::int64_t last) {
    const h5::Dataset dataset = h5::open_checked(file, path, {std::nullopt});
    hsize_t low = 0, high = h5::dimensions_of(dataset.id()).front();
    const h5::Space place(h5::checked(H5Dget_space(dataset.id()), path.c_str())),
        memory = h5::scalar_space();
    while (low < high) { // by halves: a log of collisions may have billions
        const hsize_t middle = low + (high - low) / 2, one = 1;
        std::int64_t number = 0;
        h5::checked(
            H5Sselect_hyperslab(place.id(), H5S_SELECT_SET, &middle, nullptr, &one, nullptr),
            path.c_str());
        h5::checked(
            H5Dread(dataset.id(), H5T_NATIVE_INT64, memory.id(), place.id(), H5P_DEFAULT, &number),
            path.c_str());
        if (number <= last)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

} // namespace carrom
