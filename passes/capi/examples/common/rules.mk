# Builds host.cpp of the folder it is called from against both libraries; `cargo build -p airglow-c` makes them first.
LIBRARIES ?= ../../../../target/debug
CXXFLAGS = -std=c++17 -O1 -Wall -Wextra -Wpedantic -Werror -I../common -I../../include
SYSTEM = -lvulkan -lpthread -ldl -lm
SOURCES = host.cpp $(wildcard *.hpp ../common/*.hpp) ../../include/airglow.h

all: host_static host_shared

host_static: $(SOURCES) $(LIBRARIES)/libairglow.a
	$(CXX) $(CXXFLAGS) -o $@ host.cpp $(LIBRARIES)/libairglow.a $(SYSTEM)

host_shared: $(SOURCES) $(LIBRARIES)/libairglow.so
	$(CXX) $(CXXFLAGS) -o $@ host.cpp -L$(LIBRARIES) -lairglow -Wl,-rpath,$(abspath $(LIBRARIES)) $(SYSTEM)
