// SPDX-License-Identifier: BSD-3-Clause
#include "io/trajectory.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <functional>
#include <numeric>
#include <utility>
#include <vector>

#include "io/checked_dataset.hpp"
#include "io/checkpoint_fields.hpp"
#include "io/h5md.hpp"
#include "io/segmented_file.hpp"
#include "io/xdmf.hpp"
#include "parallel/exchange.hpp"

namespace carrom {

namespace {

/// The number of discs that rank 0 collects in one round. From 16 to 256 ranks it is proportional
/// to the number of ranks, so that the number of messages for a frame does not grow.
std::uint64_t discs_at_a_time(int n_ranks) {
    constexpr std::uint64_t least = std::uint64_t{1} << 16, most = std::uint64_t{1} << 20;
    return std::clamp(least / 16 * static_cast<std::uint64_t>(n_ranks), least, most);
}

/// The index of each number in a disc's words. A vector's third component is 0.
enum Place : std::size_t {
    position = 0,
    velocity = 3,
    collisions = 6, ///< collisions with walls, then with discs
    computed = 8,
    image = computed + n_computed_numbers,
    side_columns = image + 3,
    n_words = side_columns + n_side_columns
};

/// A disc's numbers at the time of the frame, as words. Real numbers are sent as their bits.
using DiscWords = std::array<std::uint64_t, n_words>;

/// A field of a frame: `width` words of each disc, from index `place` on.
struct Field {
    std::string name;
    std::size_t place;
    hsize_t width;
    hid_t type; ///< type in the file; a shorter integer type drops the highest bytes
    std::string unit;
};

std::vector<Field> fields_of(const TrajectoryLayout& layout) {
    const auto unit = std::bind_front(h5md::unit_of, std::cref(layout.system));
    const hid_t real = layout.is_single ? H5T_IEEE_F32LE : H5T_IEEE_F64LE;
    std::vector<Field> fields;
    const auto add = [&](bool is_wanted, Field field) {
        if (is_wanted) fields.push_back(std::move(field));
    };
    add(layout.has_position, {"position", position, 3, real, unit(1, 0)});
    add(layout.has_velocity, {"velocity", velocity, 3, real, unit(1, -1)});
    add(layout.has_collisions, {"collisions", collisions, 2, H5T_STD_U64LE, ""});
    std::size_t place = computed;
    for (std::size_t k = 0; k < computed_field_table.size(); ++k) {
        const ComputedField& one = computed_field_table[k];
        add(layout.computed[k],
            {one.name, place, one.width(), one.is_count ? H5T_STD_U64LE : real, ""});
        place += one.width();
    }
    add(layout.has_image, {"image", image, 3, H5T_STD_I32LE, ""});
    layout.columns.for_each([&](SideColumn column) {
        const SideColumnInfo& info = info_of(column);
        fields.push_back({info.shown, side_columns + static_cast<std::size_t>(column), 1, real,
                          unit(0, info.is_rate ? -1 : 0)});
    });
    return fields;
}

/// One column for each field, then step, time and box.
std::vector<RecordedColumn> columns_of(const TrajectoryLayout& layout) {
    std::vector<RecordedColumn> columns;
    for (const Field& field : fields_of(layout)) {
        std::vector<hsize_t> row = {layout.system.n_discs};
        if (field.width > 1) row.push_back(field.width);
        columns.push_back({h5md::discs_path + field.name + "/value", field.type, row, field.unit});
    }
    columns.push_back({h5md::step_path, H5T_STD_I64LE, {}});
    columns.push_back({h5md::time_path, H5T_IEEE_F64LE, {}, h5md::unit_of(layout.system, 0, 1)});
    columns.push_back({h5md::edges_path, H5T_IEEE_F64LE, {3}, h5md::unit_of(layout.system, 1, 0)});
    return columns;
}

/// Steps and times are stored once; every element links to them, as H5MD allows.
void write_structure(hid_t file, const TrajectoryLayout& layout) {
    h5md::write_system(file, layout.system);
    h5md::write_bodies(file, layout.system);
    write_recorded_run(file, layout.run);
    static_cast<void>(h5::create_group(file, "/particles/discs/box/edges"));
    for (const Field& field : fields_of(layout)) {
        const h5::Group element = h5::create_group(file, h5md::discs_path + field.name);
        for (const auto& [name, path] :
             {std::pair("step", h5md::step_path), std::pair("time", h5md::time_path)})
            h5::checked(H5Lcreate_soft(path, element.id(), name, H5P_DEFAULT, H5P_DEFAULT), name);
    }
}

/// Selects the words of a disc that rank 0 collects: the layout's fields, without components that
/// are always 0.
class CollectedWords {
public:
    explicit CollectedWords(const std::vector<Field>& fields) {
        slots_.fill(none);
        for (const Field& field : fields)
            for (std::size_t k = 0; k < std::min<std::size_t>(field.width, 2); ++k) {
                slots_[field.place + k] = places_.size();
                places_.push_back(field.place + k);
            }
    }

    std::size_t n() const { return places_.size(); }
    /// Appends the collected words of a disc.
    void append(const DiscWords& words, std::vector<std::uint64_t>& to) const {
        for (const std::size_t place : places_) to.push_back(words[place]);
    }
    /// The word at `place` of the disc whose collected words begin at `collected`; 0 if words at
    /// this place are not collected.
    std::uint64_t word(const std::uint64_t* collected, std::size_t place) const {
        return slots_[place] == none ? 0 : collected[slots_[place]];
    }
    std::size_t slot_of(std::size_t place) const { return slots_[place]; }

private:
    static constexpr std::size_t none = ~std::size_t{0};
    std::vector<std::size_t> places_;
    std::array<std::size_t, n_words> slots_{};
};

/// Collects the discs of all ranks on rank 0, by slabs of ids.
class SlabStream {
public:
    SlabStream(std::span<const DiscState> discs, const SideSpans& columns,
               std::span<const ComputedNumbers> computed_numbers, std::span<const DiscImage> images,
               double clock, const TrajectoryLayout& layout, const CollectedWords& collected,
               const Communicator& communicator)
        : discs_(discs), columns_(columns), computed_(computed_numbers), images_(images),
          clock_(clock), layout_(layout), collected_(collected), communicator_(communicator),
          order_(discs.size()) {
        std::iota(order_.begin(), order_.end(), LocalIndex{0});
        std::sort(order_.begin(), order_.end(),
                  [discs](LocalIndex a, LocalIndex b) { return discs[a].id < discs[b].id; });
    }

    /// Returns the collected words of the ids [begin, end) on rank 0, and an empty span on other
    /// ranks. `begin` must be the `end` of the previous call. **Collective.**
    std::span<const std::uint64_t> next(std::uint64_t begin, std::uint64_t end) {
        const std::size_t width = collected_.n();
        std::vector<std::uint64_t> mine; // the id of each disc, and then its words
        for (; next_ < order_.size() && discs_[order_[next_]].id < end; ++next_) {
            mine.push_back(discs_[order_[next_]].id);
            collected_.append(shown(order_[next_]), mine);
        }
        slab_.assign(communicator_.is_root() ? (end - begin) * width : 0, 0);
        const auto place = [&](std::span<const std::uint64_t> some) {
            for (std::size_t k = 0; k < some.size(); k += width + 1)
                std::copy_n(some.data() + k + 1, width, slab_.data() + (some[k] - begin) * width);
        };
        stream_to_root(communicator_, mine, place, (end - begin) * (width + 1));
        if (layout_.has_image) add_images(begin, end);
        return slab_;
    }

private:
    void add_images(std::uint64_t begin, std::uint64_t end) {
        std::size_t n = 0;
        while (n < images_.size() && images_[n].id < end) ++n;
        const auto place = [&](std::span<const DiscImage> some) {
            for (const DiscImage& one : some) {
                std::uint64_t* const words = slab_.data() + (one.id - begin) * collected_.n();
                words[collected_.slot_of(image)] = static_cast<std::uint64_t>(one.x);
                words[collected_.slot_of(image + 1)] = static_cast<std::uint64_t>(one.y);
            }
        };
        stream_to_root(communicator_, images_.first(n), place, end - begin);
        images_ = images_.subspan(n);
    }

    static void add_computed(const ComputedNumbers& numbers, DiscWords& words) {
        std::size_t k = 0;
        for (const ComputedField& field : computed_field_table)
            for (const std::size_t end = k + field.width(); k < end; ++k)
                words[computed + k] = field.is_count ? static_cast<std::uint64_t>(numbers[k])
                                                     : std::bit_cast<std::uint64_t>(numbers[k]);
    }

    DiscWords shown(LocalIndex i) const {
        const DiscState& disc = discs_[i];
        const double unit = layout_.velocity_unit;
        DiscWords words{};
        const auto set = [&words](std::size_t place, double number) {
            words[place] = std::bit_cast<std::uint64_t>(number);
        };
        set(position, disc.x_at(clock_));
        set(position + 1, disc.y_at(clock_));
        set(velocity, disc.vx * unit);
        set(velocity + 1, disc.vy * unit);
        words[collisions] = disc.wall_collisions;
        words[collisions + 1] = disc.pair_collisions;
        layout_.columns.for_each([&](SideColumn column) {
            set(side_columns + static_cast<std::size_t>(column),
                columns_[column][i] * (info_of(column).is_rate ? unit : 1));
        });
        if (!computed_.empty()) add_computed(computed_[i], words);
        return words;
    }

    std::span<const DiscState> discs_;
    SideSpans columns_;
    std::span<const ComputedNumbers> computed_;
    std::span<const DiscImage> images_; ///< images of discs that are not collected yet
    double clock_;
    const TrajectoryLayout& layout_;
    const CollectedWords& collected_;
    const Communicator& communicator_;
    std::vector<LocalIndex> order_;
    std::size_t next_ = 0;
    std::vector<std::uint64_t> slab_; ///< the collected words of each disc
};

/// The bytes of a field of the discs in `slab`, in the field's type in the file.
std::vector<std::byte> bytes_of(const Field& field, const CollectedWords& collected,
                                std::span<const std::uint64_t> slab) {
    const bool is_single = H5Tequal(field.type, H5T_IEEE_F32LE) > 0;
    const std::size_t size = H5Tget_size(field.type);
    std::vector<std::byte> bytes;
    bytes.reserve(slab.size() / collected.n() * field.width * size);
    for (std::size_t disc = 0; disc < slab.size(); disc += collected.n())
        for (std::size_t k = 0; k < field.width; ++k) {
            const std::uint64_t bits = collected.word(slab.data() + disc, field.place + k);
            const auto single = static_cast<float>(std::bit_cast<double>(bits));
            const auto number = is_single ? std::as_bytes(std::span(&single, 1))
                                          : std::as_bytes(std::span(&bits, 1)).first(size);
            bytes.insert(bytes.end(), number.begin(), number.end());
        }
    return bytes;
}

} // namespace

Trajectory::Trajectory(const std::string& path, const TrajectoryLayout& layout,
                       const Communicator& communicator)
    : path_(path), layout_(layout), communicator_(communicator),
      file_(std::make_unique<SegmentedFile>(
          path, columns_of(layout), [this](hid_t index) { write_structure(index, layout_); },
          communicator)) {}

Trajectory::~Trajectory() = default;

void Trajectory::begin() {
    file_->begin();
    steps_.clear();
}

std::int64_t Trajectory::go_on(std::int64_t step, const DifferenceFrom& difference_from) {
    const bool is_there = file_->go_on(h5md::step_path, step, [&](hid_t file) {
        if (!h5::has(file, "/particles/discs")) throw FileError("is no trajectory");
        check_recorded_run(file, difference_from);
        steps_ = h5::read_column<std::int64_t>(file, h5md::step_path);
        recorded_before_ = steps_.empty() ? -1 : steps_.back();
    });
    if (!is_there) steps_.clear();
    if (!is_there || !communicator_.is_root()) return -1;
    steps_.resize(file_->n_rows());
    return steps_.empty() ? -1 : steps_.back();
}

void Trajectory::append(std::int64_t step, std::span<const DiscState> discs, double clock,
                        const SideSpans& columns, std::span<const ComputedNumbers> computed_numbers,
                        std::span<const DiscImage> images, const Box* box) {
    ensure(computed_numbers.size() == discs.size() || layout_.computed == ComputedFieldSet{},
           "computed numbers do not run along the discs");
    layout_.columns.for_each([&](SideColumn column) {
        ensure(columns[column].size() == discs.size(), "a column does not run along the discs");
    });
    SegmentedFile& file = *file_;
    file.attempt([&] { static_cast<void>(file.room()); });
    const std::vector<Field> fields = fields_of(layout_);
    const CollectedWords collected(fields);
    SlabStream stream(discs, columns, computed_numbers, images, clock, layout_, collected,
                      communicator_);
    const std::uint64_t n = layout_.system.n_discs,
                        at_a_time = discs_at_a_time(communicator_.size());
    for (std::uint64_t begin = 0; begin < n; begin += at_a_time) {
        const std::span<const std::uint64_t> slab = stream.next(begin,
                                                                std::min(begin + at_a_time, n));
        file.attempt([&] {
            for (std::size_t k = 0; k < fields.size(); ++k)
                file.write(k, bytes_of(fields[k], collected, slab));
        });
    }
    file.attempt([&] {
        const auto time = static_cast<double>(step);
        const std::array<double, 3> edges = h5md::edges_of(box ? *box : layout_.system.box);
        file.write(fields.size(), std::as_bytes(std::span(&step, 1)));
        file.write(fields.size() + 1, std::as_bytes(std::span(&time, 1)));
        file.write(fields.size() + 2, std::as_bytes(std::span(edges)));
        file.add(1);
    });
    file.finish_addition();
    steps_.push_back(step);
}

void Trajectory::commit() {
    file_->commit();
    // `describe` writes all frames, so it is called only after their number has risen by a quarter.
    if (communicator_.any(communicator_.is_root() &&
                          steps_.size() >= n_described_ + n_described_ / 4 + 1))
        describe();
}

void Trajectory::describe() {
    on_root(communicator_, path_, ExitCode::output_failure, [&] {
        write_xdmf(path_, layout_, file_->segments(), steps_);
        n_described_ = steps_.size();
    });
}

} // namespace carrom
