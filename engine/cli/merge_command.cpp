// SPDX-License-Identifier: GPL-3.0-or-later
#include "merge_command.h"

#include "errors.h"
#include "glimmer.h"
#include "picture/picture_file.h"
#include "text.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace glimmer {
namespace {

/// How the values of a channel of several pictures become one: by the rule of its pass. Channels without a layer are
/// those of the combined pass.
glimmer_pass_rule rule_of(const std::string &channel) {
    const std::string layer = channel.substr(0, channel.find('.'));
    for (uint32_t i = 0; const auto *info = glimmer_pass_info(i); ++i)
        if (layer == info->name)
            return info->rule;
    return GLIMMER_RULE_MEAN;
}

/// The same value of all pictures, joined. weights sum to 1.
float join(glimmer_pass_rule rule, const std::vector<float> &values, const std::vector<double> &weights) {
    double sum = 0, weight_sum = 0;
    for (size_t i = 0; i < values.size(); ++i) {
        const auto value = double(values[i]);
        switch (rule) {
        case GLIMMER_RULE_MEAN:
            sum += weights[i] * value;
            break;
        case GLIMMER_RULE_STANDARD_ERROR:
            sum += weights[i] * weights[i] * value * value;
            break;
        case GLIMMER_RULE_MEAN_OF_HITS: // over the pictures that hit something: their hits are not known
            if (values[i] < GLIMMER_NO_DEPTH) {
                sum += weights[i] * value;
                weight_sum += weights[i];
            }
            break;
        case GLIMMER_RULE_MATTE:
        case GLIMMER_RULE_FIRST:
            return values[0];
        case GLIMMER_RULE_COUNT:
            sum += value;
            break;
        }
    }
    if (rule == GLIMMER_RULE_MEAN_OF_HITS)
        return weight_sum > 0 ? static_cast<float>(sum / weight_sum) : GLIMMER_NO_DEPTH;
    return static_cast<float>(rule == GLIMMER_RULE_STANDARD_ERROR ? std::sqrt(sum) : sum);
}

[[noreturn]] void refuse(const std::filesystem::path &file, const std::string &why) {
    throw InputError(file.string() + ": " + why);
}

/// Position of each channel of `names` in a picture.
std::vector<size_t> positions(const Picture &picture, const std::vector<std::string> &names) {
    std::vector<size_t> result;
    for (const std::string &name : names)
        result.push_back(
            size_t(std::find(picture.channels.begin(), picture.channels.end(), name) - picture.channels.begin()));
    return result;
}

bool has(const Picture &picture, const std::string &channel) {
    return std::find(picture.channels.begin(), picture.channels.end(), channel) != picture.channels.end();
}

/// Only independent renders of one scene have a common mean whose error is known.
void expect_mergeable(const Picture &a, const std::filesystem::path &a_file, const Picture &b,
                      const std::filesystem::path &b_file) {
    if (a.width != b.width || a.height != b.height || a.window != b.window)
        refuse(b_file, std::to_string(b.window_width()) + " x " + std::to_string(b.window_height()) + " pixels at (" +
                           std::to_string(b.window[0]) + ", " + std::to_string(b.window[1]) + ") are not the " +
                           std::to_string(a.window_width()) + " x " + std::to_string(a.window_height()) + " at (" +
                           std::to_string(a.window[0]) + ", " + std::to_string(a.window[1]) + ") of " +
                           in_quotes(a_file.string()) + "; only pictures of one size can be merged");
    if (a.info.scene_hash != b.info.scene_hash)
        refuse(b_file, "shows another scene than " + in_quotes(a_file.string()) +
                           "; only renders of the very same scene can be merged");
    for (const std::string &seed : b.info.seeds)
        if (std::find(a.info.seeds.begin(), a.info.seeds.end(), seed) != a.info.seeds.end())
            refuse(b_file, "has the seed " + seed + " as " + in_quotes(a_file.string()) +
                               " has; equal seeds are not independent, render with different --seed");
    for (const auto &[one, one_file, other, other_file] :
         {std::tie(a, a_file, b, b_file), std::tie(b, b_file, a, a_file)})
        for (const std::string &channel : one.channels)
            if (rule_of(channel) != GLIMMER_RULE_STANDARD_ERROR && !has(other, channel))
                refuse(other_file,
                       "has no channel " + in_quotes(channel) + ", which " + in_quotes(one_file.string()) + " has");
}

void merge_into(std::vector<std::string> &texts, const std::vector<std::string> &more) {
    for (const std::string &text : more)
        if (std::find(texts.begin(), texts.end(), text) == texts.end())
            texts.push_back(text);
}

PictureInfo merged_info(const std::vector<Picture> &pictures) {
    PictureInfo info = pictures[0].info;
    std::vector<std::string> integrators{info.integrator}, versions{info.version};
    for (size_t i = 1; i < pictures.size(); ++i) {
        const PictureInfo &more = pictures[i].info;
        info.samples += more.samples;
        info.seconds += more.seconds;
        info.seeds.insert(info.seeds.end(), more.seeds.begin(), more.seeds.end());
        merge_into(info.biased_by, more.biased_by);
        merge_into(integrators, {more.integrator});
        merge_into(versions, {more.version});
    }
    const auto joined = [](const std::vector<std::string> &texts) {
        std::string result;
        for (const std::string &text : texts)
            result += (result.empty() ? "" : ", ") + text;
        return result;
    };
    info.integrator = joined(integrators);
    info.version = joined(versions);
    return info;
}

Picture merge(const std::vector<Picture> &pictures) {
    Picture result;
    result.width = pictures[0].width;
    result.height = pictures[0].height;
    result.pixel_aspect = pictures[0].pixel_aspect;
    result.window = pictures[0].window;
    result.info = merged_info(pictures);
    for (const std::string &channel : pictures[0].channels)
        // A standard error is known only where every part's is.
        if (std::all_of(pictures.begin(), pictures.end(),
                        [&](const Picture &picture) { return has(picture, channel); }))
            result.channels.push_back(channel);

    std::vector<double> weights;
    std::vector<std::vector<size_t>> places;
    for (const Picture &picture : pictures) {
        weights.push_back(double(picture.info.samples) / double(result.info.samples));
        places.push_back(positions(picture, result.channels));
    }
    std::vector<glimmer_pass_rule> rules;
    for (const std::string &channel : result.channels)
        rules.push_back(rule_of(channel));
    std::vector<float> values(pictures.size());
    result.pixels.reserve(result.pixel_count() * result.channels.size());
    for (size_t pixel = 0; pixel < result.pixel_count(); ++pixel) {
        for (size_t channel = 0; channel < result.channels.size(); ++channel) {
            for (size_t i = 0; i < pictures.size(); ++i)
                values[i] = pictures[i].pixels[pixel * pictures[i].channels.size() + places[i][channel]];
            result.pixels.push_back(join(rules[channel], values, weights));
        }
    }
    return result;
}

} // namespace

int run_merge(const MergeOptions &options) {
    std::vector<Picture> pictures;
    uint64_t samples = 0;
    for (const auto &file : options.inputs) {
        pictures.push_back(read_picture(file));
        samples += pictures.back().info.samples;
        for (size_t i = 0; i + 1 < pictures.size(); ++i)
            expect_mergeable(pictures[i], options.inputs[i], pictures.back(), file);
    }
    if (samples > uint64_t(std::numeric_limits<int32_t>::max()))
        throw InputError("merge: " + std::to_string(samples) +
                         " samples a pixel in all; up to 2147483647 can be written");
    write_picture(merge(pictures), options.output);
    return kDone;
}

} // namespace glimmer
