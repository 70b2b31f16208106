// SPDX-License-Identifier: BSD-3-Clause
#include "run/files/csv_table.hpp"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <utility>

#include "core/errors.hpp"
#include "run/files/data_output.hpp"
#include "run/files/report_file.hpp"

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
    const WriteProblem found = write_problem_of_stream(path_);
    if (found.is_failure) fail_with(path_, found.text);
    if (!found.text.empty()) throw InputError({{place_of(path_), 0, found.text}});
}

void CsvTable::append(const std::string& line) {
    const std::string text = (has_begun_ ? "" : header_ + '\n') + line + '\n';
    const int error = append_whole(path_, text, !has_begun_);
    if (error != 0) fail_with(path_, std::strerror(error));
    has_begun_ = true;
}

std::string plain_field(std::string text) {
    std::replace_if(
        text.begin(), text.end(),
        [](char c) { return c == ',' || c == '"' || c == '\n' || c == '\r'; }, ';');
    return text;
}

} // namespace carrom
