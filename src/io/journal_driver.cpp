// SPDX-License-Identifier: BSD-3-Clause
#include "io/journal_driver.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <memory>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "io/files.hpp"

namespace carrom {

namespace {

/// HDF5 hands these around by a pointer to their first part.
struct OpenFile {
    H5FD_t head{};
    std::unique_ptr<Descriptor> file;
    UndoJournal* journal = nullptr;
    haddr_t allocated = 0, size = 0;
};
static_assert(offsetof(OpenFile, head) == 0);

OpenFile& opened(H5FD_t* file) { return *reinterpret_cast<OpenFile*>(file); }
const OpenFile& opened(const H5FD_t* file) { return *reinterpret_cast<const OpenFile*>(file); }

/// Runs what may throw below C code that cannot pass exceptions on; the text goes to HDF5's stack
/// of errors.
template <class Act> herr_t guarded(const Act& act) {
    try {
        act();
        return 0;
    } catch (const FileError& error) {
        H5Epush2(H5E_DEFAULT, __FILE__, __func__, __LINE__, H5E_ERR_CLS, H5E_IO, H5E_WRITEERROR,
                 "%s", error.what());
        return -1;
    }
}

H5FD_t* open_driver(const char* name, unsigned flags, hid_t access, haddr_t) {
    auto file = std::make_unique<OpenFile>();
    const herr_t result = guarded([&] {
        file->journal = *static_cast<UndoJournal* const*>(H5Pget_driver_info(access));
        file->file = std::make_unique<Descriptor>(name,
                                                  (flags & H5F_ACC_RDWR) != 0 ? O_RDWR : O_RDONLY);
        file->size = file->file->size();
    });
    return result < 0 ? nullptr : &file.release()->head;
}

herr_t close_driver(H5FD_t* file) {
    delete &opened(file);
    return 0;
}

int compare(const H5FD_t* a, const H5FD_t* b) { return a == b ? 0 : a < b ? -1 : 1; }

herr_t print_features(const H5FD_t*, unsigned long* flags) {
    if (flags != nullptr)
        *flags = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA |
                 H5FD_FEAT_DATA_SIEVE | H5FD_FEAT_AGGREGATE_SMALLDATA |
                 H5FD_FEAT_DEFAULT_VFD_COMPATIBLE;
    return 0;
}

haddr_t allocated_end(const H5FD_t* file, H5FD_mem_t) { return opened(file).allocated; }

herr_t set_allocated_end(H5FD_t* file, H5FD_mem_t, haddr_t end) {
    opened(file).allocated = end;
    return 0;
}

haddr_t end_of_file(const H5FD_t* file, H5FD_mem_t) { return opened(file).size; }

herr_t read_bytes(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t place, size_t length, void* buffer) {
    return guarded([&] {
        const std::span bytes(static_cast<std::byte*>(buffer), length);
        const std::size_t n = opened(file).file->read(bytes, place);
        std::fill(bytes.begin() + static_cast<std::ptrdiff_t>(n), bytes.end(),
                  std::byte{0}); // allocated, not yet written
    });
}

herr_t write_bytes(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t place, size_t length,
                   const void* buffer) {
    return guarded([&] {
        OpenFile& target = opened(file);
        target.journal->keep(target.file->number(), place, length);
        target.file->write({static_cast<const std::byte*>(buffer), length}, place);
        target.size = std::max(target.size, place + length);
    });
}

herr_t set_size(H5FD_t* file, hid_t, hbool_t) {
    return guarded([&] {
        OpenFile& target = opened(file);
        if (target.size == target.allocated) return;
        if (target.size > target.allocated)
            target.journal->keep(target.file->number(), target.allocated,
                                 target.size - target.allocated);
        if (::ftruncate(target.file->number(), static_cast<off_t>(target.allocated)) != 0)
            fail_with_errno("its size cannot be set");
        target.size = target.allocated;
    });
}

H5FD_class_t driver_class() {
    H5FD_class_t driver{};
#ifdef H5FD_CLASS_VERSION // since HDF5 1.14
    driver.version = H5FD_CLASS_VERSION;
    driver.value = 511; // the last of those that are nobody's
#endif
    driver.name = "carrom_journal";
    driver.maxaddr = static_cast<haddr_t>(std::numeric_limits<off_t>::max());
    driver.fc_degree = H5F_CLOSE_WEAK;
    driver.fapl_size = sizeof(UndoJournal*);
    driver.open = open_driver;
    driver.close = close_driver;
    driver.cmp = compare;
    driver.query = print_features;
    driver.get_eoa = allocated_end;
    driver.set_eoa = set_allocated_end;
    driver.get_eof = end_of_file;
    driver.read = read_bytes;
    driver.write = write_bytes;
    driver.truncate = set_size;
    for (H5FD_mem_t& list : driver.fl_map)
        list = H5FD_MEM_SUPER; // one list of free space for all kinds
    return driver;
}

} // namespace

h5::Properties journalled_access(UndoJournal& journal) {
    static const H5FD_class_t driver = driver_class();
    static const hid_t id = H5FDregister(&driver);
    h5::Properties access = h5::properties(H5P_FILE_ACCESS);
    UndoJournal* const info = &journal;
    h5::checked(H5Pset_driver(access.id(), h5::checked(id, "cannot register a driver"), &info),
                "cannot choose a driver");
    return access;
}

} // namespace carrom
