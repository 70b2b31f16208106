// SPDX-License-Identifier: BSD-3-Clause
#include "io/appended_file.hpp"

#include <algorithm>

#include <fcntl.h>
#include <unistd.h>

#include "io/checked_dataset.hpp"
#include "io/files.hpp"
#include "io/journal_driver.hpp"

namespace carrom {

void AppendedFile::create(const Act& build) {
    journal_.commit(0);
    ::unlink(path_.c_str());
    h5::File file = h5::create_file(path_);
    try {
        build(file.id());
        file.close("cannot be written");
    } catch (const FileError&) {
        file.abandon();
        throw;
    }
    commit();
}

bool AppendedFile::reopen() {
    if (::access(path_.c_str(), F_OK) != 0) return false;
    roll_back(path_);
    journal_.commit(Descriptor(path_, O_RDONLY).size());
    return true;
}

void AppendedFile::open() {
    failure_.clear();
    file_ = h5::open_file(path_, journalled_access(journal_));
}

void AppendedFile::attempt(const Act& act) {
    if (!failure_.empty()) return;
    try {
        act(file_.id());
    } catch (const FileError& error) {
        failure_ = error.what();
    }
}

void AppendedFile::close() {
    attempt([this](hid_t) { file_.close("cannot be written"); });
    if (failure_.empty()) return;
    file_.abandon(); // closing would write again
    roll_back(path_);
    throw FileError(failure_);
}

void AppendedFile::commit() {
    const Descriptor file(path_, O_WRONLY);
    file.sync();
    journal_.commit(file.size());
}

void create_growing(hid_t parent, const char* name, hid_t type, std::span<const hsize_t> row,
                    std::span<const hsize_t> chunk, int level) {
    const h5::Properties creation = h5::dataset_creation();
    std::vector<hsize_t> dimensions = {0}, largest = {H5S_UNLIMITED};
    dimensions.insert(dimensions.end(), row.begin(), row.end());
    largest.insert(largest.end(), row.begin(), row.end());
    h5::checked(H5Pset_chunk(creation.id(), static_cast<int>(chunk.size()), chunk.data()), name);
    if (level > 0) {
        h5::checked(H5Pset_shuffle(creation.id()), name);
        h5::checked(H5Pset_deflate(creation.id(), static_cast<unsigned>(level)), name);
    }
    h5::checked(H5Pset_fletcher32(creation.id()), name);
    h5::Dataset dataset(
        h5::checked(H5Dcreate2(parent, name, type, h5::space(dimensions, largest).id(), H5P_DEFAULT,
                               creation.id(), H5P_DEFAULT),
                    name));
    dataset.close(name);
}

void set_length(hid_t parent, const char* name, hsize_t length) {
    h5::Dataset dataset = h5::open_dataset(parent, name);
    std::vector<hsize_t> dimensions = h5::dimensions_of(dataset.id());
    dimensions.front() = length;
    h5::checked(H5Dset_extent(dataset.id(), dimensions.data()), name);
    dataset.close(name);
}

hsize_t length_of(hid_t parent, const char* name) {
    return h5::dimensions_of(h5::open_checked(parent, name, {std::nullopt}).id()).front();
}

void write_block(hid_t parent, const char* name, std::span<const hsize_t> start,
                 std::span<const hsize_t> count, hid_t type, const void* values) {
    h5::Dataset dataset = h5::open_dataset(parent, name);
    const h5::Space target(h5::checked(H5Dget_space(dataset.id()), name)),
        memory = h5::space(count);
    h5::checked(H5Sselect_hyperslab(target.id(), H5S_SELECT_SET, start.data(), nullptr,
                                    count.data(), nullptr),
                name);
    h5::checked(H5Dwrite(dataset.id(), type, memory.id(), target.id(), H5P_DEFAULT, values), name);
    dataset.close(name);
}

hsize_t count_up_to(hid_t parent, const char* name, std::int64_t last) {
    const h5::Dataset dataset = h5::open_checked(parent, name, {std::nullopt});
    hsize_t low = 0, high = h5::dimensions_of(dataset.id()).front();
    const h5::Space target(h5::checked(H5Dget_space(dataset.id()), name)),
        memory = h5::scalar_space();
    while (low < high) { // by halves: a log of collisions may have billions
        const hsize_t middle = low + (high - low) / 2, one = 1;
        std::int64_t number = 0;
        h5::checked(
            H5Sselect_hyperslab(target.id(), H5S_SELECT_SET, &middle, nullptr, &one, nullptr),
            name);
        h5::checked(
            H5Dread(dataset.id(), H5T_NATIVE_INT64, memory.id(), target.id(), H5P_DEFAULT, &number),
            name);
        if (number <= last)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

std::vector<std::int64_t> read_numbers(hid_t parent, const char* name) {
    const h5::Dataset dataset = h5::open_checked(parent, name, {std::nullopt});
    std::vector<std::int64_t> numbers(h5::dimensions_of(dataset.id()).front());
    h5::checked(
        H5Dread(dataset.id(), H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data()),
        name);
    return numbers;
}

} // namespace carrom
