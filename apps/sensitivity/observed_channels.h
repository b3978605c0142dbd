#pragma once

#include <string>
#include <vector>

#include "bio/parameters/channel_information.h"

/// What `sensitivity` observes, and what could be observed beside it.
namespace app {

/// Channels with the standard deviations of their noise.
/// @param typed  NAME=SD each, as --observe takes them
/// @throws std::invalid_argument for what cannot be measured of the system, or a noise that is not
///   > 0
std::vector<bio::ChannelCandidate> readObserved(const std::vector<std::string>& typed,
                                                const bio::Model& model,
                                                const bio::MusculoskeletalSystem& arm);

/// "ankle_angle.moment (noise 0.5 N·m), …"; empty for none.
std::string inWords(const std::vector<bio::ChannelCandidate>& channels, const bio::Model& model);

/// All of them at these times [s].
std::vector<bio::ObservedSeries> seriesOf(const std::vector<bio::ChannelCandidate>& channels,
                                          const std::vector<double>& times);

/// Divides the rows of each channel by its noise. @param gamma  as many rows for each channel
void scaleByNoise(const std::vector<bio::ChannelCandidate>& channels, Eigen::MatrixXd& gamma);

/// bio::usualChannels without what is observed already.
/// @param coordinate  observed where no channel is named
std::vector<bio::ChannelCandidate> furtherChannels(
    const bio::MusculoskeletalSystem& arm, const std::vector<bio::ChannelCandidate>& observed,
    const std::string& coordinate);

/// Whether bio::channelGains would take longer than a second or two.
bool gainsTakeLong(std::size_t parameters, std::size_t channels);

}  // namespace app
