// Numbers of a job that depend on its stock.
#pragma once

#include "kerf/program/cut_job.h"

namespace kerf::cut_detail {

/// Whether a value is a text for the number of a key that depends on the stock.
bool needs_stock(const CutKeyText& key, const CutValue& value);
/// What is wrong with such a text, whatever the stock is, as `fault_of` states it; empty: nothing.
std::string stock_fault(const CutKeyText& key, const CutValue& value);

/// A text with the stock's sizes and faces as lengths: "stock.x/2" as "(100mm)/2".
std::string with_stock(std::string text, const Box3& stock);

}  // namespace kerf::cut_detail
