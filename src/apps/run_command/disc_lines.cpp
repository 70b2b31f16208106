// SPDX-License-Identifier: BSD-3-Clause
#include "apps/run_command/disc_lines.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <numeric>
#include <span>

#include "apps/run_command/command_options.hpp"
#include "core/errors.hpp"
#include "parallel/agreement.hpp"
#include "parallel/exchange.hpp"

namespace carrom {

namespace {

std::vector<LocalIndex> order_by_id(std::span<const DiscState> discs) {
    std::vector<LocalIndex> order(discs.size());
    std::iota(order.begin(), order.end(), LocalIndex{0});
    std::sort(order.begin(), order.end(),
              [discs](LocalIndex a, LocalIndex b) { return discs[a].id < discs[b].id; });
    return order;
}

/// The numbers of a line. Adding 0.0 turns -0.0 into 0.0, so that states with the same hash give
/// the same text.
DiscLine line_of(const DiscState& disc, double clock, double velocity_unit, const Origin& origin) {
    return {disc.id,
            disc.x_at(clock) - origin.x + 0.0,
            disc.y_at(clock) - origin.y + 0.0,
            disc.vx * velocity_unit + 0.0,
            disc.vy * velocity_unit + 0.0,
            disc.pair_collisions,
            disc.wall_collisions};
}

/// Appends a space and a number by std::to_chars, which gives the digits of printf, but is eight
/// times as fast.
void append_number(fmt::memory_buffer& text, double number, int digits) {
    std::array<char, 352> word; // long enough for any double with 16 decimals
    const auto style = digits == RunOptions::round_trip_digits ? std::chars_format::general
                                                               : std::chars_format::fixed;
    const auto end =
        std::to_chars(word.data(), word.data() + word.size(), number, style, digits).ptr;
    text.push_back(' ');
    text.append(word.data(), end);
}

template <class Integer> void append_count(fmt::memory_buffer& text, Integer count) {
    const fmt::format_int word(count);
    text.append(word.data(), word.data() + word.size());
}

} // namespace

void append_line(fmt::memory_buffer& text, std::int64_t step, const DiscLine& line, int digits,
                 bool with_counters) {
    append_count(text, step);
    text.push_back(' ');
    append_count(text, line.id);
    for (const double number : {line.x, line.y, line.vx, line.vy})
        append_number(text, number, digits);
    if (with_counters)
        for (const std::uint64_t count : {line.pair_collisions, line.wall_collisions}) {
            text.push_back(' ');
            append_count(text, count);
        }
    text.push_back('\n');
}

DiscLines::DiscLines(const SceneParameters& scene, const std::string& path, int digits,
                     const Communicator& ranks, std::uint64_t slab)
    : ranks_(ranks), wanted_(scene.text_output), last_step_(scene.steps), n_discs_(scene.n_discs),
      digits_(digits), slab_(slab), origin_(scene.origin),
      output_(ranks.is_root() ? path : std::string()) {
    agree_on_failure();
}

void DiscLines::agree_on_failure() const {
    agree(ranks_, output_.failure().empty(), output_.failure(), ExitCode::output_failure);
}

void DiscLines::close() {
    output_.close();
    agree_on_failure();
}

std::int64_t DiscLines::next_due(std::int64_t step) const {
    return wanted_ == TextOutput::every_step ? std::min(step + 1, last_step_) : last_step_;
}

bool DiscLines::is_due(std::int64_t step) const {
    if (wanted_ == TextOutput::none) return false;
    return wanted_ == TextOutput::every_step || step == 0 || step == last_step_;
}

void DiscLines::write(const DiscSystem& system) {
    const std::span<const DiscState> discs = system.shown();
    const double clock = system.clock(), velocity_unit = system.velocity_unit();
    const std::vector<LocalIndex> order = order_by_id(discs);
    auto next = order.begin();
    std::vector<DiscLine> mine;
    for (std::uint64_t begin = 0; begin < n_discs_; begin += slab_) {
        const std::uint64_t end = std::min(begin + slab_, n_discs_);
        mine.clear();
        for (; next != order.end() && discs[*next].id < end; ++next)
            mine.push_back(line_of(discs[*next], clock, velocity_unit, origin_));
        write_slab(begin, end, system.step(), mine);
    }
}

void DiscLines::write_slab(std::uint64_t begin, std::uint64_t end, std::int64_t step,
                           const std::vector<DiscLine>& mine) {
    std::vector<DiscLine> slab(ranks_.is_root() ? end - begin : 0);
    std::uint64_t n_placed = 0;
    const auto place = [&](std::span<const DiscLine> lines) {
        for (const DiscLine& line : lines) slab[line.id - begin] = line;
        n_placed += lines.size();
    };
    stream_to_root(ranks_, mine, place, slab_);
    ensure(!ranks_.is_root() || n_placed == end - begin,
           "a disc is missing from the output, or is there twice");
    const bool with_counters = step == last_step_ && step > 0;
    for (const DiscLine& line : slab) {
        append_line(output_.buffer(), step, line, digits_, with_counters);
        output_.flush_if_full();
    }
    output_.flush();
    agree_on_failure();
}

} // namespace carrom
