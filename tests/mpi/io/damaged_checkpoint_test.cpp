// SPDX-License-Identifier: BSD-3-Clause
// A damaged or forged checkpoint is an error on every rank, and the message names the damaged part.
#include "checkpoint_tools.hpp"

using namespace carrom;
using namespace carrom::test;

TEST_CASE("a damaged file is refused on every rank, with the reason") {
    const Communicator world = Communicator::world();
    const TestFolder folder(world);
    const std::string whole = folder.file("whole.h5"), path = folder.file("bad.h5");
    write_checkpoint(whole, some_header(), share(50, world, 0), world);
    const std::string good = bytes_of(whole);
    const auto refused = [&](const std::string& bytes, const std::string& reason) {
        world.barrier();
        if (world.is_root()) std::ofstream(path, std::ios::binary) << bytes;
        world.barrier();
        const std::string problem = problem_of(path, world);
        CAPTURE(problem, reason);
        CHECK(problem.substr(0, 2 + path.size()) == "2 " + path);
        CHECK(problem.find(reason) != std::string::npos);
    };
    refused("", "no HDF5 file");
    refused("some text\n", "no HDF5 file");
    refused("carrom checkpoint, format 2\nbytes 7\n", "a checkpoint of carrom 0.1");
    refused(good.substr(0, 300), "cut short");
    refused(good.substr(0, good.size() - 1), "cut short");
    refused(good + 'x', "damaged");
    refused(std::string(4096, '\0') + good.substr(512), "no HDF5 file");
    for (const std::size_t place : {std::size_t{40}, std::size_t{4095}, std::size_t{4096},
                                    std::size_t{5000}, good.size() - 1}) {
        std::string bytes = good;
        bytes[place] = static_cast<char>(bytes[place] ^ 1);
        refused(bytes, "damaged");
    }
    CHECK(problem_of(whole, world).empty());
    CHECK(problem_of(folder.file("none.h5"), world).find("No such file") != std::string::npos);
}

TEST_CASE("damage is told by the data set that it is in") {
    const Communicator world = Communicator::world();
    const TestFolder folder(world);
    const std::string path = folder.file("a.h5");
    CheckpointHeader header = some_header();
    header.columns.add(SideColumn::spin);
    const std::vector<DiscState> mine = share(5000, world, 0);
    const SideColumns columns = spins_of(mine);
    write_checkpoint(path, header, mine, world, {}, {}, columns.spans());
    const std::string good = bytes_of(path);
    const Checksums sums = read_checksums(h5::open_file(path, h5::Access::read).id());
    CHECK(sums.data.size() == 10);
    CHECK(good.substr(sums.place.begin, sums.place.end - sums.place.begin) == sums.text());
    const auto reported = [&](std::vector<std::size_t> places) {
        world.barrier();
        if (world.is_root()) {
            std::string bytes = good;
            for (const std::size_t place : places)
                bytes[place] = static_cast<char>(bytes[place] ^ 16);
            std::ofstream(path, std::ios::binary) << bytes;
        }
        world.barrier();
        const std::string problem = problem_of(path, world);
        return problem.substr(std::min(problem.size(), problem.rfind(": ") + 2));
    };
    for (const DiscData& data : sums.data)
        for (const std::size_t place :
             {data.place.begin, data.place.begin + 2500 * data.bytes_per_row, data.place.end - 1})
            CHECK(reported({place}) == data.path);
    CHECK(reported({sums.data[2].place.begin + 100, sums.data[5].place.end - 9}) ==
          "/carrom/discs/x, /carrom/discs/vy");
    CHECK(reported({good.find("box]\nsize")}).starts_with("bytes besides the data sets"));
    for (const std::size_t place : {0u, 31u, 40u, 340u})
        CHECK(reported({sums.place.begin + place}).find("its checksums") != std::string::npos);
}

namespace {

/// Flips one bit of each of these bytes in turn, which all ranks must detect. Returns the number of
/// undetected flips.
int unnoticed_flips(const std::vector<std::size_t>& places, const Communicator& world) {
    const TestFolder folder(world);
    const std::string path = folder.file("a.h5");
    write_checkpoint(path, some_header(), share(20, world, 0), world);
    const std::string good = bytes_of(path);
    int n_unnoticed = 0;
    for (std::size_t k = 0; k < places.size(); ++k) {
        const std::size_t place = places[k] % good.size();
        const auto put = [&](char byte) {
            world.barrier();
            if (world.is_root())
                std::fstream(path, std::ios::binary | std::ios::in | std::ios::out)
                    .seekp(static_cast<std::streamoff>(place))
                    .put(byte);
            world.barrier();
        };
        put(static_cast<char>(good[place] ^ (1 << (k % 8))));
        n_unnoticed += problem_of(path, world).empty() ? 1 : 0;
        put(good[place]);
    }
    CHECK(problem_of(path, world).empty());
    return n_unnoticed;
}

} // namespace

TEST_CASE("random flipped bits are noticed") {
    const Communicator world = Communicator::world();
    std::mt19937 random(3210);
    std::vector<std::size_t> places(300);
    for (std::size_t& place : places) place = random();
    CHECK(unnoticed_flips(places, world) == 0);
}

TEST_CASE("a flipped bit in any byte is noticed", "[.long]") {
    const Communicator world = Communicator::world();
    std::vector<std::size_t> places(40000); // more flips than the file has bytes
    for (std::size_t k = 0; k < places.size(); ++k) places[k] = k;
    CHECK(unnoticed_flips(places, world) == 0);
}

namespace {

/// Writes correct checksums into a changed file, without those of `dropped`.
void write_checksums_again(const std::string& path, const std::string& dropped) {
    h5::File file = h5::open_file(path, h5::Access::write);
    Checksums sums;
    for (const StateColumn& column : disc_columns)
        sums.data.push_back({std::string("/carrom/discs/") + column.name, 0, 0, {}, {}});
    for (const SampleColumn& column : sample_columns) {
        const std::string name = column.path;
        if (name != dropped) sums.data.push_back({name, 0, 0, {}, {}});
    }
    REQUIRE(H5Ldelete(file.id(), checksums_path, H5P_DEFAULT) >= 0);
    h5::write_scalar(file.id(), checksums_path, sums.text());
    sums = read_checksums(file.id());
    file.close("");
    const std::string bytes = bytes_of(path);
    for (DiscData& one : sums.data)
        one.checksum = checksum_of_block(
            std::as_bytes(std::span(bytes))
                .subspan(one.place.begin, one.place.end - one.place.begin),
            0);
    sums.others = checksum_of_others(path, sums.left_out());
    file = h5::open_file(path, h5::Access::write);
    h5::overwrite(file.id(), checksums_path, sums.text());
    file.close("");
}

} // namespace

TEST_CASE("a forged checkpoint with right checksums is refused where its places are none") {
    const Communicator world = Communicator::world();
    const TestFolder folder(world);
    const std::string whole = folder.file("whole.h5"), path = folder.file("forged.h5");
    StoredSamples samples;
    samples.sums = {1, 2, 3};
    samples.have_first_places = samples.have_lengths = samples.have_velocities = true;
    samples.have_images = true;
    for (DiscId id = 0; id < 20; ++id) // less than one piece, so all discs are on rank 0
        if (world.is_root())
            samples.first_places.push_back({id, 0.01, 0.02, 1, -2, 0.1, 0.2, 3, -4});
    write_checkpoint(whole, some_header(), share(20, world, 0), world, {}, samples);
    const auto forged = [&](const std::string& dataset, const std::function<void(hid_t)>& change) {
        world.barrier();
        if (world.is_root()) {
            std::filesystem::copy_file(whole, path,
                                       std::filesystem::copy_options::overwrite_existing);
            h5::File file = h5::open_file(path, h5::Access::write);
            change(file.id());
            file.close("");
            write_checksums_again(path, dataset);
        }
        world.barrier();
        return problem_of(path, world);
    };
    CHECK(forged("", [](hid_t) {}).empty());
    for (const SampleColumn& column : sample_columns) {
        const std::string name = column.path;
        const std::string problem = forged(
            name, [&](hid_t file) { H5Ldelete(file, name.c_str(), H5P_DEFAULT); });
        CHECK(problem.find("has no " + name) != std::string::npos);
        for (const double number : {std::numeric_limits<double>::quiet_NaN(),
                                    std::numeric_limits<double>::infinity(), 1e300}) {
            // Any finite number can be a velocity.
            if (std::isfinite(number) && column.is_there == &StoredSamples::have_velocities)
                continue;
            const std::string other = forged("", [&](hid_t file) {
                h5::write_rows(h5::open_dataset(file, name).id(), {7, 8}, H5T_NATIVE_DOUBLE,
                               &number, h5::Transfer::independent);
            });
            CHECK(other.find(name + " holds what is no place") != std::string::npos);
        }
    }
}
