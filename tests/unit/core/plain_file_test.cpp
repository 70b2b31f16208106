// SPDX-License-Identifier: BSD-3-Clause
// Only plain files can be opened for reading, and no other kind of file makes an open wait.
#include <filesystem>
#include <iterator>

#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include "catch.hpp"

#include "core/plain_file.hpp"

using namespace carrom;

namespace {

namespace fs = std::filesystem;

std::string text_of(std::ifstream stream) {
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

OpenProblem problem_with(const fs::path& path) {
    OpenProblem problem;
    const std::ifstream stream = open_plain_file(path.string(), problem);
    CHECK(problem.text.empty() == static_cast<bool>(stream));
    return problem;
}

} // namespace

TEST_CASE("plain files are opened, also through links, and nothing else is") {
    const fs::path folder = fs::temp_directory_path() /
                            ("carrom_plain_" + std::to_string(::getpid()));
    fs::create_directory(folder);
    std::ofstream(folder / "plain") << "a\r\nb\0c";
    fs::create_symlink("plain", folder / "link");
    CHECK(text_of(open_plain_file((folder / "plain").string())) == "a\r\nb");
    CHECK(text_of(open_plain_file((folder / "link").string())) == "a\r\nb");

    REQUIRE(::mkfifo((folder / "pipe").c_str(), 0600) == 0);
    CHECK(problem_with(folder / "pipe").is_special); // opening a pipe without a writer would wait
    fs::create_symlink("pipe", folder / "to_pipe");
    CHECK(problem_with(folder / "to_pipe").text == "is not a plain file");
    CHECK(problem_with("/dev/null").is_special);
    CHECK(problem_with(folder).is_folder);
    CHECK(problem_with(folder / "none").text.find("cannot be opened: No such file") == 0);
    CHECK(problem_with(std::string("plain\0x", 7)).text == "is no file's name");

    const int socket = ::socket(AF_UNIX, SOCK_STREAM, 0);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    const std::string name = (folder / "socket").string();
    REQUIRE(name.size() < sizeof address.sun_path);
    name.copy(address.sun_path, name.size());
    REQUIRE(::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0);
    CHECK(problem_with(name).is_special);
    ::close(socket);
    fs::remove_all(folder);
}
