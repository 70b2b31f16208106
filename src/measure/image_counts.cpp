// SPDX-License-Identifier: BSD-3-Clause
#include "measure/image_counts.hpp"

#include <cmath>
#include <cstdlib>

#include "core/errors.hpp"
#include "engine/engine.hpp"
#include "parallel/exchange.hpp"

namespace carrom {

DiscStates flown_on(const DiscSystem& system) {
    Frame frame = system.frame();
    frame.periods = {};
    DiscStates discs;
    discs.reserve(system.discs().size());
    for (const DiscState& disc : system.discs())
        discs.push_back(frame.in_box(disc, system.clock()));
    return discs;
}

ImageCounts::ImageCounts(DiscSystem& system, const Communicator& ranks)
    : system_(system), ranks_(ranks),
      pieces_(ranks.sum(std::uint64_t{system.discs().size()}), ranks.size()) {
    const std::uint64_t end = pieces_.begin(pieces_.first_of(ranks_.rank() + 1));
    for (DiscId id = pieces_.begin(pieces_.first_of(ranks_.rank())); id < end; ++id)
        counts_.push_back({id, 0, 0});
    system_.engine().record_crossings_in(crossings_);
}

ImageCounts::~ImageCounts() { system_.engine().forget_crossings_in(crossings_); }

void ImageCounts::go_on(std::span<const FirstPlace> stored, double FirstPlace::* x,
                        double FirstPlace::* y) {
    PieceStream stream(ranks_, stored, ranks_.sum(std::uint64_t{stored.size()}),
                       [](const FirstPlace& place) { return place.id; });
    counts_.clear();
    for (std::uint64_t round = 0; round < stream.pieces().n_rounds(); ++round)
        for (const FirstPlace& place : stream.next())
            counts_.push_back({place.id, static_cast<std::int32_t>(place.*x),
                               static_cast<std::int32_t>(place.*y)});
}

void ImageCounts::begin_anew() {
    crossings_.clear();
    for (DiscImage& count : counts_) count.x = count.y = 0;
}

std::span<const DiscImage> ImageCounts::counts() {
    add(counts_, crossings_);
    crossings_.clear();
    return counts_;
}

void ImageCounts::store(std::vector<FirstPlace>& places, double FirstPlace::* x,
                        double FirstPlace::* y) {
    places.resize(counts().size());
    for (std::size_t k = 0; k < places.size(); ++k) {
        places[k].id = counts_[k].id;
        places[k].*x = counts_[k].x;
        places[k].*y = counts_[k].y;
    }
}

std::vector<DiscImage> ImageCounts::now() {
    static_cast<void>(counts());
    std::vector<DiscImage> images = counts_;
    const DiscStates flown = flown_on(system_);
    const std::span<const DiscState> shown = system_.shown();
    const Box box = system_.engine().box();
    std::vector<Crossing> in_flight;
    for (std::size_t i = 0; i < flown.size(); ++i)
        if (flown[i].x != shown[i].x || flown[i].y != shown[i].y)
            in_flight.push_back({flown[i].id, std::round((flown[i].x - shown[i].x) / box.x),
                                 std::round((flown[i].y - shown[i].y) / box.y)});
    add(images, in_flight);
    return images;
}

void ImageCounts::add(std::vector<DiscImage>& counts, std::span<const Crossing> crossings) const {
    std::vector<std::vector<Crossing>> out(static_cast<std::size_t>(ranks_.size()));
    for (const Crossing& crossing : crossings)
        out[static_cast<std::size_t>(
                slab_of(pieces_.of(crossing.disc), pieces_.count(), ranks_.size()))]
            .push_back(crossing);
    for (const Crossing& crossing : send_to_owners(ranks_, out).items) {
        DiscImage& count = counts[crossing.disc - counts.front().id];
        count.x += static_cast<std::int32_t>(crossing.x);
        count.y += static_cast<std::int32_t>(crossing.y);
        ensure(std::abs(count.x) <= most_images && std::abs(count.y) <= most_images,
               "a disc has gone round a periodic box 2^30 times; no file counts further");
    }
}

} // namespace carrom
