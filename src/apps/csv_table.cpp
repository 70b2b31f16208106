// SPDX-License-Identifier: BSD-3-Clause
#include "apps/csv_table.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "apps/data_output.hpp"
#include "core/errors.hpp"

namespace carrom {

namespace {

std::string place_of(const std::string& path) { return "--output " + path; }

[[noreturn]] void refuse(const std::string& path, const std::string& text) {
    throw InputError({{place_of(path), 0, text}});
}

[[noreturn]] void fail(const std::string& path, const std::string& text) {
    throw CollectiveError(place_of(path) + ": " + text, ExitCode::output_failure);
}

std::size_t n_fields(const std::string& line) {
    return static_cast<std::size_t>(std::count(line.begin(), line.end(), ',')) + 1;
}

/// The first `n` fields.
std::string first_fields(const std::string& line, std::size_t n) {
    std::size_t end = 0;
    for (std::size_t k = 0; k < n && end != std::string::npos; ++k)
        end = line.find(',', end == 0 ? 0 : end + 1);
    return line.substr(0, end);
}

/// The last `n` fields.
std::string last_fields(const std::string& line, std::size_t n) {
    std::size_t begin = line.size();
    for (std::size_t k = 0; k < n && begin != std::string::npos; ++k)
        begin = line.rfind(',', begin - 1);
    return begin == std::string::npos ? line : line.substr(begin + 1);
}

void cut(const std::string& path, std::uintmax_t size) {
    std::error_code error;
    std::filesystem::resize_file(path, size, error);
    if (error) fail(path, error.message());
}

/// What is there to go on with; only a plain file has an end to go on from.
std::string read_table(const std::string& path) {
    std::error_code error;
    const auto status = std::filesystem::status(path, error);
    if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
        refuse(path, "is no plain file, which a table has to be");
    if (const Obstacle found = obstacle_to_opening(path); !found.text.empty()) {
        if (found.is_failure) fail(path, found.text);
        refuse(path, found.text);
    }
    std::string text;
    if (std::ifstream file(path, std::ios::binary); file)
        text.assign(std::istreambuf_iterator<char>(file), {});
    return text;
}

} // namespace

CsvTable::CsvTable(std::string path, Layout layout)
    : path_(std::move(path)), layout_(std::move(layout)) {
    layout_.header += '\n';
    std::string text = read_table(path_);
    lock_ = std::make_unique<WriteLock>(path_ + ".lock");
    if (!lock_->holder().empty())
        refuse(path_, lock_->holder() + " is writing to it; give each share a table of its own");
    text = read_table(path_); // as the one before has left it
    if (layout_.header.starts_with(text) && text != layout_.header) {
        if (!text.empty()) cut(path_, 0);
        return;
    }
    if (!text.starts_with(layout_.header))
        refuse(path_, "is not a table of this version of carrom accuracy; name another file");
    take_in(text);
    if (size_ < text.size()) cut(path_, size_);
}

void CsvTable::take_in(const std::string& text) {
    const std::size_t wanted = n_fields(layout_.header);
    std::vector<Problem> problems;
    size_ = layout_.header.size();
    for (int line_number = 2;; ++line_number) {
        const std::size_t end = text.find('\n', size_);
        if (end == std::string::npos) break;
        const std::string line = text.substr(size_, end - size_);
        if (n_fields(line) != wanted)
            problems.push_back(
                {path_, line_number,
                 fmt::format("has {} fields and not {}: remove the line, its trial is run again",
                             n_fields(line), wanted)});
        keys_.insert(first_fields(line, layout_.n_key));
        n_foreign_ += last_fields(line, layout_.n_origin) != layout_.origin;
        size_ = end + 1;
    }
    if (!problems.empty()) throw InputError(std::move(problems));
}

void CsvTable::append(const std::string& key, const std::string& numbers) {
    if (size_ == 0) write(layout_.header);
    write(fmt::format("{},{},{}\n", key, numbers, layout_.origin));
    keys_.insert(key);
}

void CsvTable::write(const std::string& text) {
    int error = 0;
    {
        std::ofstream file(path_, std::ios::binary | std::ios::app);
        file << text << std::flush;
        if (!file) error = errno != 0 ? errno : EIO;
        file.close(); // some file systems tell of a full disk only here
        if (!file && error == 0) error = errno != 0 ? errno : EIO;
    } // a stream that has failed writes once more when it ends
    if (error != 0) {
        std::error_code ignored;
        std::filesystem::resize_file(path_, size_, ignored);
        fail(path_, std::strerror(error));
    }
    size_ += text.size();
}

std::string plain_field(std::string text) {
    std::replace_if(
        text.begin(), text.end(),
        [](char c) { return c == ',' || c == '"' || c == '\n' || c == '\r'; }, ';');
    return text;
}

} // namespace carrom
