// SPDX-License-Identifier: GPL-3.0-or-later
// As volume_reader.cpp, it includes ITK and no Eigen.
#include "tools/case_builder/otsu.h"

#include <itkHistogram.h>
#include <itkOtsuMultipleThresholdsCalculator.h>

#include <algorithm>
#include <cmath>

namespace insula::case_builder {

std::size_t otsu_bin(std::span<const std::uint64_t> counts) {
  using Histogram = itk::Statistics::Histogram<double>;
  const auto histogram = Histogram::New();
  Histogram::SizeType size(1);
  Histogram::MeasurementVectorType least(1), most(1);
  size[0] = counts.size(), least[0] = 0, most[0] = double(counts.size());
  histogram->SetMeasurementVectorSize(1);
  histogram->Initialize(size, least, most);
  for (std::size_t b = 0; b < counts.size(); ++b) histogram->SetFrequency(b, counts[b]);
  const auto calculator = itk::OtsuMultipleThresholdsCalculator<Histogram>::New();
  calculator->SetInputHistogram(histogram);
  calculator->SetNumberOfThresholds(1);
  calculator->Compute();
  const double end = std::round(calculator->GetOutput()[0]);  // of the darker class
  return std::clamp(std::size_t(std::max(1.0, end)), std::size_t(1), counts.size() - 1);
}

}  // namespace insula::case_builder
