// SPDX-License-Identifier: BSD-3-Clause
#include "csv_table.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <utility>

#include "carrom/core/errors.hpp"
#include "data_output.hpp"

namespace carrom {

namespace {

[[noreturn]] void refuse(const std::string& path, const std::string& text) { throw InputError({{"--output " + path, 0, text}}); }

} // namespace

CsvTable::CsvTable(std::string path, std::string header, std::size_t n_key_fields)
    : path_(std::move(path)), n_key_fields_(n_key_fields) {
    header += '\n';
    if (const Obstacle found = obstacle_to_opening(path_); !found.text.empty()) refuse(path_, found.text);
    std::string text;
    if (std::ifstream file(path_, std::ios::binary); file) text.assign(std::istreambuf_iterator<char>(file), {});
    const std::size_t whole = text.rfind('\n') == std::string::npos ? 0 : text.rfind('\n') + 1;
    std::error_code error;
    if (whole < text.size()) std::filesystem::resize_file(path_, whole, error);
    if (error) refuse(path_, error.message());
    text.resize(whole);
    if (text.empty()) {
        std::ofstream file(path_, std::ios::binary | std::ios::app);
        if (!(file << header << std::flush)) refuse(path_, std::strerror(errno));
        return;
    }
    if (!text.starts_with(header)) refuse(path_, "is not a table of this version of carrom accuracy; name another file");
    for (std::size_t begin = header.size(); begin < text.size();) {
        const std::size_t end = text.find('\n', begin);
        keys_.insert(key_in(text.substr(begin, end - begin)));
        begin = end + 1;
    }
}

void CsvTable::append(const std::string& line) {
    std::ofstream file(path_, std::ios::binary | std::ios::app);
    file << line + '\n' << std::flush;
    if (!file) refuse(path_, std::strerror(errno));
    keys_.insert(key_in(line));
}

std::string CsvTable::key_in(const std::string& line) const {
    std::size_t end = 0;
    for (std::size_t k = 0; k < n_key_fields_ && end != std::string::npos; ++k) end = line.find(',', end == 0 ? 0 : end + 1);
    return line.substr(0, end);
}

std::string plain_field(std::string text) {
    std::replace_if(text.begin(), text.end(), [](char c) { return c == ',' || c == '"' || c == '\n' || c == '\r'; }, ';');
    return text;
}

} // namespace carrom
