#include "tables/formats/foreign_format.h"

#include <fmt/format.h>

#include <array>
#include <filesystem>

#include "bio/tables/file_error.h"
#include "bio/tables/recording.h"
#include "tables/cells.h"
#include "tables/recording_layouts.h"

namespace bio::tables {
namespace {

struct ForeignFormat {
  std::string_view begins;     ///< first bytes; empty: by the extension
  std::string_view extension;  ///< in lower case; empty: by the first bytes alone
  std::string_view what;
  std::string_view how;
  std::size_t at = 0;  ///< where `begins` stands
};

constexpr std::string_view asCsv = "save the sheet as CSV UTF-8";
constexpr std::string_view otb =
    "export it from OT BioLab+ as EDF or CSV (File, Export), one column per channel";
constexpr std::string_view bts = "export it from BTS EMG-Analyzer or SMART Analyzer as C3D";
constexpr std::string_view noraxon = "export it from myoRESEARCH or MR3 as CSV, C3D or EDF";
constexpr std::string_view delsys =
    "export it from Trigno Discover or EMGworks File Utility as CSV";
constexpr std::string_view matlab =
    "write its signals in MATLAB with writetable(table(t, emg), 'emg.csv')";
constexpr std::string_view unpack = "unpack it";

// those of one signature and several extensions first
constexpr std::array foreignFormats{
    ForeignFormat{"PK\x03\x04", ".xlsx", "an Excel workbook", asCsv},
    ForeignFormat{"PK\x03\x04", ".xlsm", "an Excel workbook", asCsv},
    ForeignFormat{"PK\x03\x04", ".ods", "an OpenDocument sheet", asCsv},
    ForeignFormat{"PK\x03\x04", ".otb4", "an OTB4 recording", otb},
    ForeignFormat{"PK\x03\x04", ".mvx", "a Noraxon record", noraxon},
    ForeignFormat{"PK\x03\x04", "", "a ZIP archive", unpack},
    ForeignFormat{"\xD0\xCF\x11\xE0", ".xls", "an Excel workbook", asCsv},
    ForeignFormat{"\xD0\xCF\x11\xE0", "",
                  "a compound document of Microsoft's (an old Excel workbook?)", asCsv},
    ForeignFormat{"ustar", ".otb+", "an OTB+ recording", otb, 257},
    ForeignFormat{"ustar", "", "a TAR archive (an OTB+ recording?)", otb, 257},
    ForeignFormat{"\x1F\x8B", "", "compressed by gzip", "gunzip it"},
    ForeignFormat{"MATLAB 5.0 MAT-file", "", "a MATLAB file", matlab},
    ForeignFormat{"MATLAB 7.3 MAT-file", "", "a MATLAB file", matlab},
    ForeignFormat{"\x89HDF\r\n", ".mat", "a MATLAB file", matlab},
    ForeignFormat{"\x89HDF\r\n", ".nwb", "an NWB file", "write its signals as CSV"},
    ForeignFormat{"\x89HDF\r\n", "", "an HDF5 file", "write its signals as CSV"},
    ForeignFormat{"\x82\x4B\x60\x41", "", "a BTS TDF recording", bts},
    ForeignFormat{"BTS ASCII", "", "a BTS EMT export", bts},
    ForeignFormat{"Brain Vision Data Exchange", "", "the header of a BrainVision recording",
                  "convert it to EDF, e.g. with EEGLAB or MNE"},
    ForeignFormat{"GDF ", "", "a GDF recording", "convert it to EDF"},
    ForeignFormat{"CFWB", "", "a LabChart binary file", "export it from LabChart as text"},
    ForeignFormat{"\x93NUMPY", "", "a NumPy array",
                  "write it in Python with numpy.savetxt and a row of names"},
    ForeignFormat{"PAR1", "", "a Parquet table", "write it in Python with pandas to_csv"},
    ForeignFormat{"SQLite format 3", "", "an SQLite database", "write its signals as CSV"},
    ForeignFormat{"%PDF", "", "a PDF document", "ask for the numbers as CSV"},
    ForeignFormat{"{\\rtf", "", "a document in RTF", "save it as plain text"},
    ForeignFormat{"ID;P", "", "a sheet in SYLK (.slk)", asCsv},
    ForeignFormat{"<?xml", ".mvnx", "an Xsens MVNX recording",
                  "export it from Xsens MVN as C3D or CSV"},
    ForeignFormat{"<?xml", "", "an XML document", "export the recording as C3D or CSV"},
    ForeignFormat{"<html", "", "a web page", "download the file itself"},
    ForeignFormat{"<!DOCTYPE html", "", "a web page", "download the file itself"},
    ForeignFormat{"", ".mat", "a MATLAB file", matlab},
    ForeignFormat{"", ".tdf", "a BTS TDF recording", bts},
    ForeignFormat{"", ".emt", "a BTS EMT export", bts},
    ForeignFormat{"", ".hpf", "a Delsys EMGworks recording", delsys},
    ForeignFormat{"", ".shpf", "a Delsys Trigno Discover recording", delsys},
    ForeignFormat{"", ".mvx", "a Noraxon record", noraxon},
    ForeignFormat{"", ".nor", "a Noraxon record", noraxon},
    ForeignFormat{"", ".otb", "an OT BioLab recording", otb},
    ForeignFormat{"", ".otb+", "an OTB+ recording", otb},
    ForeignFormat{"", ".sig", "a signal file of OT Bioelettronica", otb},
    ForeignFormat{"", ".x2d", "a Vicon recording of cameras",
                  "export the trial from Nexus as C3D or CSV"},
    ForeignFormat{"", ".x1d", "a Vicon recording of analog signals",
                  "export the trial from Nexus as C3D or CSV"},
    ForeignFormat{"", ".qtm", "a Qualisys recording", "export it from QTM as C3D or TSV"},
    ForeignFormat{"", ".cap", "a Cortex recording", "export it from Cortex as C3D or TRC"},
    ForeignFormat{"", ".anb", "a Cortex file of analog signals",
                  "export it from Cortex as C3D or .anc"},
    ForeignFormat{"", ".acq", "a BIOPAC AcqKnowledge recording", "export it as text or EDF"},
    ForeignFormat{"", ".adicht", "a LabChart recording", "export it from LabChart as text"},
    ForeignFormat{"", ".smr", "a Spike2 recording", "export it from Spike2 as text"},
    ForeignFormat{"", ".smrx", "a Spike2 recording", "export it from Spike2 as text"},
    ForeignFormat{"", ".vhdr", "the header of a BrainVision recording",
                  "convert it to EDF, e.g. with EEGLAB or MNE"},
    ForeignFormat{"", ".tdms", "a LabVIEW TDMS recording", "export it from DIAdem or Excel as CSV"},
};

}  // namespace

std::string foreignFormat(const std::string& file, std::string_view bytes) {
  const std::string extension = lowered(std::filesystem::path(file).extension().string());
  for (const ForeignFormat& one : foreignFormats) {
    const bool begins = one.begins.empty() ||
                        (bytes.size() > one.at && bytes.substr(one.at).starts_with(one.begins));
    if (!begins || (!one.extension.empty() && one.extension != extension)) continue;
    // a text is read for what it is, whatever it is called
    if (one.begins.empty() && bytes.substr(0, 4096).find('\0') == bytes.npos &&
        one.extension != ".emt") {
      continue;
    }
    return fmt::format("{}: is {}, must be a text table, C3D, TRC, XDF, EDF or BDF ({})", file,
                       one.what, one.how);
  }
  return "";
}

std::string looksLike(const std::string& file) {
  try {
    switch (detectFormat(file)) {
      case RecordingFormat::table:
      case RecordingFormat::columns:
      case RecordingFormat::automatic:
        return "";
      case RecordingFormat::nexus:
        return "; it looks like a Vicon Nexus export, which `fisherhill emg` reads";
      case RecordingFormat::trigno:
        return "; it looks like a Delsys Trigno export, which `fisherhill emg` reads";
      case RecordingFormat::emgworks:
        return "; it looks like a Delsys EMGworks export, which `fisherhill emg` reads";
      case RecordingFormat::noraxon:
        return "; it looks like a Noraxon export, which `fisherhill emg` reads";
      case RecordingFormat::listing:
        return "; it looks like the listing of a dynamometer, which `fisherhill emg` reads";
      default:
        return "; it looks like a recording, which `fisherhill emg` reads";
    }
  } catch (const FileError&) {
    return "";
  }
}

}  // namespace bio::tables
