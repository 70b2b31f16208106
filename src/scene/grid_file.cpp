// SPDX-License-Identifier: BSD-3-Clause
#include "scene/grid_file.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "core/errors.hpp"
#include "scene/number.hpp"
#include "scene/read_scene.hpp"

namespace carrom {

namespace {

/// The longest allowed line: 64 characters for each of 2^18 numbers. A double needs at most 30.
constexpr std::size_t most_characters = std::size_t{1} << 24;

class Rows {
public:
    Rows(const std::string& path, std::size_t most) : path_(path), most_(most) {}

    std::string read() {
        std::ifstream file = open_input(path_);
        std::string line;
        for (line_ = 1; std::getline(file, line); ++line_) take(line);
        if (file.bad()) refuse("cannot be read to its end");
        line_ = 0;
        if (text_.empty()) refuse("has no numbers");
        return '[' + text_ + ']';
    }

private:
    [[noreturn]] void refuse(std::string text) const {
        throw InputError({{path_, line_, std::move(text)}});
    }
    void take(std::string& line) {
        if (line.size() > most_characters) refuse("a line of more than 16 MiB");
        line.resize(std::min(line.find('#'), line.size()));
        std::replace(line.begin(), line.end(), ',', ' ');
        split_words(line, most_ + 1, words_);
        if (words_.empty()) return;
        if (n_columns_ == 0) n_columns_ = words_.size();
        if (words_.size() != n_columns_)
            refuse(fmt::format("a row of {} numbers, and the first row has {}", words_.size(),
                               n_columns_));
        n_ += words_.size();
        if (n_ > most_) refuse(fmt::format("more than {} numbers", most_));
        text_ += text_.empty() ? "[" : ", [";
        for (std::size_t k = 0; k < words_.size(); ++k) {
            const auto number = parse_double(words_[k]);
            if (!number || !std::isfinite(*number))
                refuse(fmt::format("{} is not a number", in_quotes(words_[k])));
            text_ += fmt::format("{}{}", k == 0 ? "" : ", ", *number);
        }
        text_ += ']';
    }

    std::string path_;
    std::size_t most_, n_ = 0, n_columns_ = 0;
    std::int64_t line_ = 0;
    std::vector<std::string_view> words_;
    std::string text_;
};

} // namespace

std::string read_rows(const std::string& path, std::size_t most) { return Rows(path, most).read(); }

} // namespace carrom
