#pragma once

#include <string>

/// Files of the source tree that many tests give to the program, from its top folder.
namespace support {

inline const std::string model = "models/elbow8.osim";
inline const std::string slow = "emg_data/curl_slow.sto";

}  // namespace support
