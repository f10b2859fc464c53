// Buffers of the heat-occlusion test; include before shared/exchange_pass.h.
FW_READ(HEAT_OCCLUSION) FW_READ(STATE) FW_READ(HEAT) FW_READ(MATERIALS)
#define FW_PASS_OCCLUSION
