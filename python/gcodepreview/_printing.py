"""Printing: temperatures, fans and extruding motions as steps of the toolpath, and the commands around
them.
"""

import math

from ._arguments import GcodePreviewError, number, positive

_MAX_ACCELERATION = 1e9  # mm/s2


class Printing:
    """The part of `gcodepreview` that prints. The G-code is that of a Marlin printer."""

    def _start_printing(self):
        self.feedrate = 0.0
        self.nozzlediameter, self.filamentdiameter = 0.4, 1.75
        self.extrusionwidth, self.layerheight = 0.6, 0.2

    def _setting(self, text):
        self.toolpath.verbatim(text)

    def initializeforprinting(
        self, nozzlediameter=0.4, filamentdiameter=1.75, extrusionwidth=0.6, layerheight=0.2
    ):
        self.nozzlediameter = positive(nozzlediameter, "nozzlediameter")
        self.filamentdiameter = positive(filamentdiameter, "filamentdiameter")
        self.extrusionwidth = positive(extrusionwidth, "extrusionwidth")
        self.layerheight = positive(layerheight, "layerheight")
        if self.filamentdiameter != 1.75:
            self.toolpath.note(f"filament_diameter = {self.filamentdiameter:g}")
        self.toolpath.home()
        self._commanded = None
        self.extrusion_normal_length = 1 / (math.pi * (self.filamentdiameter / 2) ** 2)

    def setandwaitforextrudertemperature(self, temperature):
        self.toolpath.temperature("nozzle", number(temperature, "temperature"), wait=True)

    def setextrudertemperature(self, temperature):
        self.toolpath.temperature("nozzle", number(temperature, "temperature"))

    def setbedtemperature(self, temperature):
        self.toolpath.temperature("bed", number(temperature, "temperature"))

    def setandwaitforbedtemperature(self, temperature):
        self.toolpath.temperature("bed", number(temperature, "temperature"), wait=True)

    def setchambertemperature(self, temperature):
        self.toolpath.temperature("chamber", number(temperature, "temperature"))

    def setandwaitforchambertemperature(self, temperature):
        self.toolpath.temperature("chamber", number(temperature, "temperature"), wait=True)

    def setfansoff(self):
        self.toolpath.fan(0.0)

    def setfanspeed(self, fan, speed):
        """Set the speed of a fan, 0 to 255."""
        self.toolpath.fan(_value(speed, "speed") / 255, int(_value(fan, "fan")))

    def pauseforclearbuffer(self):
        self._setting("M400")

    def setfeedratio(self, feedratio):
        """Percent of the feeds."""
        self._setting(f"M220 S{_value(feedratio, 'feedratio'):g}")

    def setspeedratio(self, speedratio):
        """Percent of the extrusion."""
        self._setting(f"M221 S{_value(speedratio, 'speedratio'):g}")

    def setacceleration(self, acceleration):
        """Set the acceleration of beads and travel, mm/s2."""
        value = _value(acceleration, "acceleration")
        if not 0 < value <= _MAX_ACCELERATION:
            raise GcodePreviewError(
                f"acceleration must be above 0 and at most {_MAX_ACCELERATION:g}, not {value:g}"
            )
        self.toolpath.motion_limits("acceleration", beads=value, travel=value)

    def setextrusionabsolute(self, acceleration=True):
        """Not needed: the post writes the extruder's mode."""

    def setbuildpercentage(self, percent):
        self._setting(f"M73 P{_value(percent, 'percent'):g}")

    def setfilamentsensor(self, enabled=True):
        """Whether the printer stops when the filament ends."""
        self._setting("M412 S1" if enabled else "M412 S0")

    def displaymessage(self, message):
        """Show a line of text on the printer's display."""
        message = str(message)
        if not message.isprintable() or any(c in message for c in ";()"):
            raise GcodePreviewError("message must be one line without ; and parentheses")
        self._setting(f"M117 {message}")

    def clearmessage(self):
        """Clear the printer's display."""
        self._setting("M117")

    def _feed_filament(self, length, feedrate):
        if self._commanded is None:
            raise GcodePreviewError("the position of the nozzle is unknown; move it first")
        area = math.pi * (self.filamentdiameter / 2) ** 2
        self._catch_up()
        self.toolpath.extrude(self._position(), feed=positive(feedrate, "feedrate"), volume=length * area)

    def retract(self, length=1, feedrate=2400):
        """Draw back a length of filament, mm."""
        self._feed_filament(-positive(length, "length"), feedrate)

    def unretract(self, length=1, feedrate=2400):
        """Push a length of filament forward again, mm."""
        self._feed_filament(positive(length, "length"), feedrate)

    def liftandprimenozzle(self, liftfeed=5000, extrusionfeed=2400):
        """Lift the nozzle to Z5 and retract 2 mm of filament."""
        moves = self.moveatfeedrate(self.mpx, self.mpy, 5, liftfeed)
        area = math.pi * (self.filamentdiameter / 2) ** 2
        self.toolpath.extrude(
            self._position(), feed=positive(extrusionfeed, "extrusionfeed"), volume=-2 * area
        )
        return moves

    def extrude(self, ex, ey, ez, extrusionwidth=0, layerheight=0, feedrate=0):
        """Lay a bead to a point; its volume is that of a stadium of the given width and height."""
        end = (number(ex, "ex"), number(ey, "ey"), number(ez, "ez"))
        width = positive(extrusionwidth or self.extrusionwidth, "extrusionwidth")
        height = positive(layerheight or self.layerheight, "layerheight")
        if width < height:
            raise GcodePreviewError(
                f"extrusionwidth must be at least the layer height {height:g}, not {width:g}"
            )
        feed = feedrate or self.feedrate or self.feed
        self._catch_up()
        length = math.dist(self._position(), end)
        volume = length * (height * (width - height) + math.pi * (height / 2) ** 2)
        self.toolpath.extrude(end, feed=positive(feed, "feedrate"), volume=volume, width=width, height=height)
        return self._arrive("extrude", end)


def _value(value, name):
    """A number, or a text of one as the original required."""
    if isinstance(value, str):
        try:
            value = float(value)
        except ValueError:
            raise GcodePreviewError(f"{name} must be a number, not {value!r}") from None
    value = number(value, name)
    if value < 0:
        raise GcodePreviewError(f"{name} must not be below 0, not {value:g}")
    return value
