// SPDX-License-Identifier: BSD-3-Clause
#include "scene/read_scene.hpp"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <sstream>

#include <fmt/format.h>

#include "core/plain_file.hpp"
#include "scene/checked_scene.hpp"
#include "scene/legacy_header.hpp"
#include "scene/line_reader.hpp"
#include "scene/number.hpp"
#include "scene/overrides.hpp"
#include "scene/settings.hpp"
#include "scene/toml_text.hpp"

namespace carrom {

namespace {

constexpr std::size_t longest_toml = std::size_t{64} << 20;

bool is_toml(const std::string& name) { return std::filesystem::path(name).extension() == ".toml"; }

[[noreturn]] void refuse(const std::string& name, std::int64_t line, const std::string& text) {
    throw InputError({{name, line, text}});
}

void check_stream(const std::istream& stream, const std::string& name) {
    if (stream.bad()) refuse(name, 0, "cannot be read to its end");
}

std::string read_all(std::istream& stream, const std::string& name) {
    std::string text;
    std::string block(std::size_t{1} << 16, '\0');
    while (stream.read(block.data(), static_cast<std::streamsize>(block.size())) ||
           stream.gcount() > 0) {
        text.append(block, 0, static_cast<std::size_t>(stream.gcount()));
        if (text.size() > longest_toml)
            refuse(name, 0,
                   "a TOML scene of more than 64 MiB; put the discs into a file of their own "
                   "(discs.file)");
    }
    check_stream(stream, name);
    return text;
}

/// Reads one line character by character, so that the stream stops directly after the line.
bool take_line(std::istream& stream, std::string& line) {
    line.clear();
    for (int c = stream.get(); c != std::istream::traits_type::eof(); c = stream.get()) {
        line += static_cast<char>(c);
        if (c == '\n' || line.size() > LineReader::longest_line) break;
    }
    return !line.empty();
}

/// Skips blank lines before the first disc. Returns true if anything follows them.
bool skip_blank(std::istream& stream, std::int64_t& n_lines) {
    for (int c = stream.peek(); c != std::istream::traits_type::eof(); c = stream.peek()) {
        if (c != ' ' && c != '\t' && c != '\r' && c != '\n') return true;
        n_lines += c == '\n';
        stream.get();
    }
    return false;
}

/// Whether the next line begins with a digit. Then it is the first disc, because legacy texts may
/// have no `print` or `perf` between the number of steps and the discs.
bool begins_a_disc(std::istream& stream, std::int64_t& n_lines) {
    if (!skip_blank(stream, n_lines)) return false;
    const int c = stream.peek();
    return c >= '0' && c <= '9';
}

} // namespace

std::ifstream open_input(const std::string& path) {
    OpenProblem problem;
    std::ifstream stream = open_plain_file(path, problem);
    if (problem.is_special)
        problem.text += "; the legacy text format from a pipe or a device is read from standard "
                        "input, as in `carrom run -`";
    if (!problem.text.empty()) refuse(path, 0, problem.text);
    return stream;
}

SceneText read_scene_text(std::istream& stream, const std::string& name) {
    SceneText input{name, {}, 0, false, {}};
    if (is_toml(name)) {
        input.text = read_all(stream, name);
        return input;
    }
    std::string line;
    for (int found = 0; found < legacy_header_lines;) {
        if (found == legacy_header_lines - 1 && begins_a_disc(stream, input.lines_before_discs))
            break;
        if (!take_line(stream, line)) break;
        input.lines_before_discs += 1;
        if (line.size() > LineReader::longest_line)
            refuse(name, input.lines_before_discs, "a line of more than 4096 characters");
        if (input.lines_before_discs == 1 && line.starts_with(byte_order_mark))
            line.erase(0, byte_order_mark.size());
        std::string_view content = line;
        if (content.empty()) continue;
        if (content.back() == '\n') content.remove_suffix(1);
        content = trimmed(content);
        if (found == 0 && (content.starts_with('[') || content.starts_with('#')))
            refuse(name, input.lines_before_discs,
                   "looks like TOML, which is read from files whose names end in .toml");
        found += !content.empty();
        input.text += line;
    }
    input.discs_follow = skip_blank(stream, input.lines_before_discs);
    check_stream(stream, name);
    return input;
}

SceneParameters read_scene(const SceneText& input, const std::vector<std::string>& overrides) {
    Problems problems;
    SceneParameters scene = read_scene(input, overrides, problems);
    if (!problems.empty()) throw InputError(std::move(problems));
    return scene;
}

SceneParameters read_scene(const SceneText& input, const std::vector<std::string>& overrides,
                           Problems& all_problems) {
    Settings settings;
    Problems problems;
    bool is_parsed = true;
    if (is_toml(input.name))
        is_parsed = add_toml(settings, problems, input.text, input.name);
    else
        add_legacy_header(settings, problems, input.text, input.name, input.discs_follow);
    add_overrides(settings, problems, overrides);
    SceneParameters scene;
    scene.name = input.name;
    scene.text = input.text;
    scene.lines_before_discs = input.lines_before_discs;
    scene.discs_follow = input.discs_follow;
    scene.overrides = overrides;
    if (is_parsed) fill_scene(scene, settings, problems, input.columns ? &*input.columns : nullptr);
    const auto line_of = [](const Problem& p) {
        return p.line > 0 ? p.line : std::numeric_limits<std::int64_t>::max();
    };
    std::stable_sort(problems.begin(), problems.end(),
                     [&](const Problem& a, const Problem& b) { return line_of(a) < line_of(b); });
    all_problems.insert(all_problems.end(), problems.begin(), problems.end());
    return scene;
}

SceneParameters read_scene(std::string_view text, const std::string& name,
                           const std::vector<std::string>& overrides) {
    std::istringstream stream{std::string(text)};
    return read_scene(read_scene_text(stream, name), overrides);
}

} // namespace carrom
