// SPDX-License-Identifier: BSD-3-Clause
#include "stored_scene/discs_from.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <stdexcept>
#include <streambuf>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/errors.hpp"
#include "io/frame_file.hpp"

namespace carrom {

namespace {

constexpr std::uint64_t block = 1 << 16;
constexpr std::array columns = {"x", "y", "vx", "vy"}; // columns of a disc's line, after its id

[[noreturn]] void refuse(const std::string& path, const std::string& text) {
    throw InputError({{path, 0, text}});
}

std::size_t frame_of(const std::string& path, const FileSummary& summary,
                     std::optional<std::int64_t> step) {
    if (summary.kind == FileKind::collisions)
        refuse(path, "is a log of collisions; discs.from takes a checkpoint or a trajectory");
    for (const char* column : columns)
        if (!summary.has(column))
            refuse(path, "its frames lack positions or velocities; discs.from takes both");
    if (summary.steps.empty()) refuse(path, "has no frame");
    if (!step) return summary.steps.size() - 1;
    const auto found = std::find(summary.steps.begin(), summary.steps.end(), *step);
    if (found == summary.steps.end())
        refuse(path, fmt::format("has no frame of step {}; its frames are of steps {} to {}", *step,
                                 summary.steps.front(), summary.steps.back()));
    return static_cast<std::size_t>(found - summary.steps.begin());
}

/// The number of discs of each species that have not departed.
std::vector<std::uint64_t> count_species(const std::vector<Species>& species,
                                         const std::vector<std::uint64_t>& departed) {
    std::vector<std::uint64_t> counts;
    std::uint64_t end = 0;
    for (const Species& one : species) {
        const std::uint64_t begin = end;
        end += one.count;
        const auto n_left = std::ranges::lower_bound(departed, end) -
                            std::ranges::lower_bound(departed, begin);
        counts.push_back(one.count - static_cast<std::uint64_t>(n_left));
    }
    return counts;
}

/// The row of the file that contains the disc with the new id `id`.
std::uint64_t row_of(std::uint64_t id, const std::vector<std::uint64_t>& departed) {
    std::uint64_t row = id;
    for (const std::uint64_t left : departed) {
        if (left > row) break;
        row += 1;
    }
    return row;
}

/// Generates lines of discs on demand, one block of discs at a time.
class LinesOfDiscs : public std::streambuf {
public:
    LinesOfDiscs(FrameFile file, std::size_t frame, std::vector<std::size_t> places,
                 const Origin& origin, ShareOfDiscs share)
        : file_(std::move(file)), frame_(frame), places_(std::move(places)),
          moved_x_(origin.x - file_.summary().origin[0]),
          moved_y_(origin.y - file_.summary().origin[1]), share_(std::move(share)),
          first_row_(row_of(share_.ids.begin, share_.departed)) {
        begin_anew();
    }

protected:
    int_type underflow() override {
        n_before_ += lines_.size();
        lines_.clear();
        while (lines_.empty() && next_ < share_.ids.end) make_lines();
        if (lines_.empty()) return traits_type::eof();
        setg(lines_.data(), lines_.data(), lines_.data() + lines_.size());
        return traits_type::to_int_type(*gptr());
    }

    /// Supports `tellg` and a return to the beginning.
    pos_type seekoff(off_type offset, std::ios::seekdir from, std::ios::openmode) override {
        if (from == std::ios::beg && offset == 0) return begin_anew();
        if (from != std::ios::cur || offset != 0) return pos_type(off_type(-1));
        return pos_type(static_cast<off_type>(n_before_) + (gptr() - eback()));
    }
    pos_type seekpos(pos_type place, std::ios::openmode) override {
        return place == pos_type(0) ? begin_anew() : pos_type(off_type(-1));
    }

private:
    pos_type begin_anew() {
        next_ = share_.ids.begin;
        row_ = first_row_;
        next_left_ = std::ranges::lower_bound(share_.departed, row_) - share_.departed.begin();
        n_before_ = 0;
        lines_.clear();
        setg(nullptr, nullptr, nullptr);
        return pos_type(0);
    }
    /// Formats the lines of the next block of rows; departed discs have no lines.
    void make_lines() {
        const std::uint64_t begin = row_, end = std::min(begin + block, file_.summary().n_rows);
        read(begin, end);
        auto out = std::back_inserter(lines_);
        for (; row_ < end && next_ < share_.ids.end; ++row_) {
            if (next_left_ < std::ssize(share_.departed) && departed(next_left_) == row_) {
                ++next_left_;
                continue;
            }
            fmt::format_to(out, "{}", next_);
            for (const std::size_t place : places_)
                fmt::format_to(out, " {}", rows_[place][row_ - begin]);
            lines_ += '\n';
            ++next_;
        }
    }
    std::uint64_t departed(std::ptrdiff_t k) const {
        return share_.departed[static_cast<std::size_t>(k)];
    }
    /// Reads rows. An error means that the file was damaged after its check. Only this rank has the
    /// error, so it must not be an InputError, which all ranks would have to throw.
    void read(std::uint64_t begin, std::uint64_t end) {
        try {
            file_.read(frame_, begin, end, rows_);
            if (moved_x_ != 0)
                for (double& x : rows_[places_[0]]) x += moved_x_;
            if (moved_y_ != 0)
                for (double& y : rows_[places_[1]]) y += moved_y_;
        } catch (const InputError& error) {
            throw std::runtime_error(std::string("discs.from: ") + error.what());
        }
    }

    FrameFile file_;
    std::size_t frame_;
    std::vector<std::size_t> places_; ///< indices of the columns in the file
    double moved_x_, moved_y_;        ///< the scene's origin minus the file's origin
    ShareOfDiscs share_;
    std::uint64_t first_row_, row_ = 0;     ///< the share's first row, and the next row to read
    std::uint64_t next_ = 0, n_before_ = 0; ///< new id of the next disc; bytes of earlier blocks
    std::ptrdiff_t next_left_ = 0;          ///< index of the next departed disc in `departed`
    std::string lines_;
    Rows rows_;
};

/// A stream that owns its source and rethrows exceptions of the source.
class StreamOfDiscs : public std::istream {
public:
    explicit StreamOfDiscs(std::unique_ptr<LinesOfDiscs> lines)
        : std::istream(lines.get()), lines_(std::move(lines)) {
        exceptions(std::ios::badbit);
    }

private:
    std::unique_ptr<LinesOfDiscs> lines_;
};

} // namespace

FileOfDiscs read_discs_from(const std::string& path, std::optional<std::int64_t> step,
                            const SideColumnSet& wanted, const Origin& origin,
                            const std::optional<ShareOfDiscs>& share) {
    FrameFile file(path);
    file.check_numbers();
    const std::size_t frame = frame_of(path, file.summary(), step);
    FileOfDiscs discs;
    discs.departed = share ? share->departed : file.find_departed(frame);
    discs.n_discs = file.summary().n_rows - discs.departed.size();
    if (discs.n_discs == 0) refuse(path, "all its discs departed by an open side");
    if (file.summary().has(info_of(SideColumn::swapped_radius).shown))
        refuse(path, "its discs have exchanged their radii (effects.swap), and a new scene would "
                     "give them others; try: a restart, or effects.swap.until_step in its scene");
    discs.radius = file.summary().radius;
    discs.n_by_species = count_species(file.summary().species, discs.departed);
    std::vector<std::size_t> places;
    for (const char* column : columns) places.push_back(file.summary().place_of(column));
    std::vector<std::string> names;
    wanted.for_each([&](SideColumn column) {
        if (!file.summary().has(info_of(column).shown)) return;
        places.push_back(file.summary().place_of(info_of(column).shown));
        names.push_back(fmt::format("\"{}\"", info_of(column).name));
    });
    if (!names.empty()) discs.columns = fmt::format("[{}]", fmt::join(names, ", "));
    discs.lines = std::make_unique<StreamOfDiscs>(std::make_unique<LinesOfDiscs>(
        std::move(file), frame, std::move(places), origin,
        share.value_or(ShareOfDiscs{{0, discs.n_discs}, discs.departed})));
    return discs;
}

} // namespace carrom
