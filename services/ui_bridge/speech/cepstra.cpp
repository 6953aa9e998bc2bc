#include "services/ui_bridge/speech/cepstra.h"

#include <sphinxbase/cmd_ln.h>
#include <sphinxbase/err.h>
#include <sphinxbase/fe.h>

#include "services/ui_bridge/speech/acoustics.h"

namespace beckon::ui_bridge::speech {
namespace {

void SubtractMean(std::vector<Cepstrum>& cepstra) {
  Cepstrum mean{};
  const auto n = static_cast<float>(cepstra.size());
  for (const auto& cepstrum : cepstra) {
    for (size_t i = 0; i < mean.size(); ++i) mean[i] += cepstrum[i] / n;
  }
  for (auto& cepstrum : cepstra) {
    for (size_t i = 0; i < mean.size(); ++i) cepstrum[i] -= mean[i];
  }
}

const arg_t* Arguments() {
  static const arg_t arguments[] = {waveform_to_cepstral_command_line_macro(),
                                    {nullptr, 0, nullptr, nullptr}};
  return arguments;
}

}  // namespace

struct CepstralAnalyser::State {
  cmd_ln_t* config = nullptr;
  fe_t* front = nullptr;
};

void CepstralAnalyser::Close::operator()(State* state) const {
  if (state->front != nullptr) fe_free(state->front);
  if (state->config != nullptr) cmd_ln_free_r(state->config);
  delete state;
}

Result<CepstralAnalyser> CepstralAnalyser::Open(const std::string& acoustic_folder) {
  err_set_logfp(nullptr);
  CepstralAnalyser analyser(new State);
  State& state = *analyser.state_;
  const std::string path = acoustic_folder + "/feat.params";
  state.config = cmd_ln_parse_file_r(nullptr, Arguments(), path.c_str(), FALSE);
  if (state.config != nullptr) {
    cmd_ln_set_float_r(state.config, "-samprate", kSampleRate);
    // Segments are found elsewhere, and every frame keeps its place.
    cmd_ln_set_boolean_r(state.config, "-remove_silence", FALSE);
    state.front = fe_init_auto_r(state.config);
  }
  if (state.front == nullptr || fe_get_output_size(state.front) != kCepstrum) {
    return Error{path + ": expected the front end of an acoustic model with " +
                 std::to_string(kCepstrum) +
                 " coefficients; install pocketsphinx-en-us, or set [speech] model"};
  }
  return analyser;
}

std::vector<Cepstrum> CepstralAnalyser::Analyse(std::span<const int16_t> samples) {
  std::vector<Cepstrum> cepstra(samples.size() / kSamplesPerFrame + 8);
  std::vector<mfcc_t*> rows;
  for (auto& cepstrum : cepstra) rows.push_back(cepstrum.data());
  const int16_t* at = samples.data();
  size_t left = samples.size();
  auto n = static_cast<int32>(rows.size());
  int32 unused = 0;
  fe_start_stream(state_->front);
  fe_start_utt(state_->front);
  fe_process_frames(state_->front, &at, &left, rows.data(), &n, &unused);
  int32 last = 0;
  if (n < static_cast<int32>(rows.size()))
    fe_end_utt(state_->front, rows[static_cast<size_t>(n)], &last);
  cepstra.resize(static_cast<size_t>(n + last));
  SubtractMean(cepstra);
  return cepstra;
}

}  // namespace beckon::ui_bridge::speech
