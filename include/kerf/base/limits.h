// Limits of the input: the table of all maxima that bound memory and time for broken or hostile input.
// Exceeding one is an error with a code; docs/manual/limits.md lists those that a user can reach. Defaults of
// options are taken from here.
//
// Not here: tolerances (tolerance.h), and constants of an algorithm, which stay beside it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace kerf::limits {

// ---- files and texts, bytes
/// 4 GB, or what a pointer of 32 bits can address (in WebAssembly).
inline constexpr auto kFourGigabytes =
    static_cast<std::size_t>(std::min<std::uint64_t>(std::uint64_t{4} << 30, SIZE_MAX));
inline constexpr std::size_t kMaxProgramBytes = kFourGigabytes;             // G-code or gcmc, on disk
inline constexpr std::size_t kMaxStreamBytes = std::size_t{256} << 20;      // pipes and standard input
inline constexpr std::size_t kMaxSubprogramBytes = std::size_t{64} << 20;   // a called .ngc file
inline constexpr std::size_t kMaxGcmcSourceBytes = std::size_t{256} << 20;  // one gcmc source file
inline constexpr std::size_t kMaxProfileBytes = std::size_t{1} << 20;  // a post, machine or material file
inline constexpr std::size_t kMaxToolFileBytes = std::size_t{16} << 20;
inline constexpr std::size_t kMaxToolLibraryBytes = std::size_t{64} << 20;  // of another program, unpacked
inline constexpr std::size_t kMaxUnpackedBytes = kFourGigabytes;            // the model inside a 3MF
inline constexpr std::size_t kMaxLineBytes = 1'000'000;                     // of G-code
inline constexpr std::size_t kMaxToolOptionBytes = 4096;                    // --tool
inline constexpr std::size_t kMaxStockOptionBytes = 200;  // --stock, --fixture, --flip, --shift
inline constexpr std::size_t kMaxNameBytes = 200;         // of a tool in a library; cut off there
inline constexpr std::size_t kMaxMessagesPerCode = 50;    // kept; the rest is counted

// ---- numbers and sizes
inline constexpr double kMaxNumber = 1e12;              // of a G-code word
inline constexpr double kMaxResult = 1e30;              // of a G-code expression
inline constexpr double kMaxCoordinate = 1e7;           // mm, of a toolpath or mesh: 10 km
inline constexpr double kMaxOutlineCoordinate = 1e60;   // mm: squares of it are still finite
inline constexpr double kMaxStockSize = 1e5;            // mm along an edge
inline constexpr double kMaxBarSize = 1e4;              // mm, of a bar on the fourth axis
inline constexpr double kMaxToolSize = 1e4;             // mm
inline constexpr int kMaxTableToolNumber = 99'999'999;  // of tool files and libraries
inline constexpr int kMaxToolNumber = 999'999'999;      // of programs
inline constexpr double kMaxSpeed = 1e6;                // mm/min and rpm, of calls
inline constexpr double kMaxDwellSeconds = 1e6;
inline constexpr double kMaxExtrudedVolume = 1e9;  // mm3 in one motion
inline constexpr double kMaxBeadWidth = 20.0;      // mm; more volume per length is a blob
inline constexpr int kMaxThreads = 1024;
inline constexpr int kMaxPictureSide = 8192;  // pixels

// ---- toolpaths
inline constexpr std::size_t kMaxPathSteps = 50'000'000;
/// Steps that a program may make by cycles, loops and curves beyond one per two bytes of its text.
inline constexpr std::size_t kMaxGeneratedSteps = 4'000'000;
inline constexpr int kMaxTurns = 10'000;       // whole turns of one arc
inline constexpr int kMaxChords = 10'000;      // of one arc or curve
inline constexpr int kMaxPecks = 100'000;      // in one hole
inline constexpr int kMaxHoles = 10'000;       // L or K of one canned cycle
inline constexpr int kMaxThreadPasses = 1000;  // G76
inline constexpr int kMaxFans = 100;
inline constexpr int kMaxExtruders = 100;

// ---- G-code: subprograms, loops, expressions
inline constexpr std::size_t kMaxRepeatedBytes = 500'000'000;  // text read again after jumps
inline constexpr int kMaxCallDepth = 100;
inline constexpr double kMaxLoopRepeats = 1e9;         // O-word repeat
inline constexpr double kMaxSubprogramRepeats = 9999;  // M98 L
inline constexpr int kMaxExpressionDepth = 200;
inline constexpr std::size_t kMaxSplinePoints = 10'000;
inline constexpr int kMaxSplineOrder = 20;

// ---- gcmc
inline constexpr int kMaxStatementDepth = 400;  // parentheses, blocks and operators in one statement
inline constexpr int kMaxIncludeDepth = 64;
inline constexpr std::size_t kMaxSourceFiles = 10'000;
inline constexpr std::size_t kMaxSyntaxNodes = 5'000'000;
inline constexpr std::size_t kMaxInstructions = 50'000'000;
inline constexpr std::size_t kMaxScriptMemory = std::size_t{2} << 30;  // bytes of vectors, lists and strings
inline constexpr std::size_t kMaxScriptCalls = 20'000;                 // nested
inline constexpr std::uint64_t kMaxQuietSteps = 500'000'000;           // loop passes and calls without output
inline constexpr std::uint64_t kMaxScriptSteps = 1'000'000'000'000;    // in all
inline constexpr std::uint64_t kMaxScriptOutput = std::uint64_t{2} << 30;  // bytes; a call counts as one more
inline constexpr std::size_t kMaxListGrowth = 50'000'000;  // entries added by one index or shift

// ---- meshes and left-over stock
inline constexpr std::size_t kMaxTriangles = 50'000'000;
inline constexpr std::size_t kMaxMeshParts = 10'000;    // of a 3MF, and uses of them
inline constexpr int kMaxMeshPartDepth = 32;            // parts within parts of a 3MF
inline constexpr std::size_t kMaxSceneNodes = 100'000;  // of a GLB
inline constexpr int kMaxSceneDepth = 64;               // nodes within nodes of a GLB
inline constexpr std::size_t kMaxLeftOverColumns = 100'000'000;
inline constexpr std::size_t kMaxLeftOverIntervals = 200'000'000;
inline constexpr std::size_t kMaxStockCrossings = 200'000'000;  // surfaces of a stock mesh on all columns

// ---- tools and posts
inline constexpr std::size_t kMaxProfilePoints = 10'000;  // of a drawn tool
inline constexpr std::size_t kMaxToolAliases = 100;       // numbers of one tool
inline constexpr std::size_t kMaxTemplateLines = 1000;    // of one template of a post
inline constexpr std::size_t kMaxPostedFiles = 1000;      // one per tool
inline constexpr std::size_t kMaxTemplateValueBytes = 400;

// ---- outlines and regions
inline constexpr std::size_t kMaxRegionEdges = 12'000'000;          // about 400 bytes each
inline constexpr std::size_t kMaxRegionIntersections = 20'000'000;  // of all edges of a computation
inline constexpr std::size_t kMaxSelfIntersections = 10'000'000;    // of one outline
inline constexpr std::size_t kMaxMedialChords = 2'000'000;          // about a kilobyte each

// ---- simulation
inline constexpr std::size_t kMaxColumns = 400'000'000;
inline constexpr std::size_t kMaxPrintIntervals = 100'000'000;  // 20 bytes each
inline constexpr int kMaxIntervalsPerColumn = 20'000;           // of a print

// ---- ranges of options
inline constexpr double kThinnestFilament = 0.1, kThickestFilament = 20.0;       // mm
inline constexpr double kThinnestBeam = 0.001, kWidestBeam = 50.0;               // mm, of a laser
inline constexpr double kThickestSpoilboard = 1000.0;                            // mm
inline constexpr double kFinestResolution = 0.0005, kCoarsestResolution = 50.0;  // mm, distance of columns
inline constexpr double kMaxPasses = 10'000.0;                                   // of one depth

}  // namespace kerf::limits
