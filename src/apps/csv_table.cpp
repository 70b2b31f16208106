// SPDX-License-Identifier: BSD-3-Clause
#include "apps/csv_table.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>

#include <unistd.h>

#include "apps/data_output.hpp"
#include "core/errors.hpp"

namespace carrom {

namespace {

std::string place_of(const std::string& path) { return "--output " + path; }

[[noreturn]] void fail_with(const std::string& path, const std::string& text) {
    throw CollectiveError(place_of(path) + ": " + text, ExitCode::output_failure);
}

} // namespace

CsvTable::CsvTable(std::string path, std::string header)
    : path_(std::move(path)), header_(std::move(header)) {
    std::error_code ignored;
    if (std::filesystem::exists(path_, ignored))
        throw InputError({{place_of(path_), 0, "is there already; name a new file"}});
    const Obstacle found = obstacle_to_opening(path_);
    if (found.is_failure) fail_with(path_, found.text);
    if (!found.text.empty()) throw InputError({{place_of(path_), 0, found.text}});
}

void CsvTable::append(const std::string& line) {
    if (!file_) {
        file_.reset(std::fopen(path_.c_str(), "wbx")); // x: not over a file that came meanwhile
        if (!file_) fail_with(path_, std::strerror(errno));
        std::setbuf(file_.get(), nullptr);
        write(header_);
    }
    write(line);
}

void CsvTable::write(const std::string& line) {
    const std::string text = line + '\n';
    const std::size_t written = std::fwrite(text.data(), 1, text.size(), file_.get());
    if (written < text.size()) {
        const int error = errno;
        static_cast<void>(::ftruncate(fileno(file_.get()), size_)); // half a line is no line
        fail_with(path_, std::strerror(error));
    }
    size_ += static_cast<long>(text.size());
}

std::string plain_field(std::string text) {
    std::replace_if(
        text.begin(), text.end(),
        [](char c) { return c == ',' || c == '"' || c == '\n' || c == '\r'; }, ';');
    return text;
}

} // namespace carrom
