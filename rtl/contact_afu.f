// The Verilog of afu_top, each file after those it needs. Names are relative to this file's folder. From any folder:
//   verilator -F FOLDER/contact_afu.f   (Questa, VCS and Xcelium know -F too)
//   yosys -p "read_verilog FOLDER/afu_top.v; hierarchy -libdir FOLDER -check -top afu_top"
//   iverilog -s afu_top -y FOLDER FOLDER/afu_top.v   (it has no -F; in this folder -f contact_afu.f does)
spl2_transmit.v
spl2_sequence.v
spl2_registers.v
contact_afu_control.v
contact_afu_packer.v
line_memory.v
contact_afu_dispatcher.v
contact_afu_credits.v
contact_afu_collector.v
contact_afu_feeder.v
fp_greater_e10f23z_normal.v
fp_sqrt_e10f23z_normal_every_5_last.v
fp_sqrt_e10f23z_normal_every_5_first.v
fp_sqrt_e10f23z_normal_every_5.v
fp_add_magnitudes_e10f23z_normal.v
fp_convert_e8f23_finite_to_e10f23z.v
multiplier_12x12.v
fp_mul_e10f23z_normal.v
fp_add_e10f23z_normal.v
fp_recip_e10f23z_normal_every_5_last.v
fp_recip_e10f23z_normal_every_5_first.v
fp_recip_e10f23z_normal_every_5.v
fp_halve_e10f23z_normal.v
fp_at_most_e10f23z_normal.v
fp_convert_e10f23z_normal_to_e8f23.v
sphere_kernel.v
scpu.v
scpu_slot.v
contact_afu.v
spl2_acknowledge.v
afu_top.v
