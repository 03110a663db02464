//! A render graph as plain data: declare by use, compile to a plan of order, barriers and reasons; makes no Vulkan call.
