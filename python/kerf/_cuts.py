"""Operations on regions, outlines, points and meshes, as of `kerf cut`. See `kerf.op`."""

# Written by tests/tools/make_operations.py from the table of keys.

from ._operations import run as _run


def pocket(
    region,
    tool,
    *,
    depth,
    top=0.0,
    stepdown=0.0,
    stepover=0.4,
    feed=None,
    material=None,
    machine=None,
    plunge=0.0,
    retract=None,
    clearance=0.5,
    allowance=0.0,
    direction="climb",
    entry="helix",
    entry_angle=3.0,
    helix_radius=0.0,
    pattern="offset",
    engagement=60.0,
    angle=0.0,
    finish=0.0,
    rest_tool=None,
    rpm=0.0,
    name="",
):
    """Cut all inside a region; its holes are islands.

    Parameters
    ----------
    region : Region or list of outlines
        What is cut out; outlines as in `Region`, mm.
    tool : Tool, str or int
        Such as ``'square d=6'``; its number in the program is that of the Tool, else 1.
    depth : float
        Below the surface, mm.
    top : float
        Z of the surface of the material, mm.
    stepdown : float
        Maximum depth of a pass; 0: one pass, mm.
    stepover : float
        Distance of paths as a fraction of the diameter of the tool.
    feed : float, optional
        Feed of cuts. Without it, the chip load in `material` gives it, mm/min.
    material : str, optional
        For a feed that is not given, such as 'MDF' or 'aluminium'.
    machine : str, optional
        File of the machine whose limits a chosen feed keeps.
    plunge : float
        Maximum feed downwards; 0: half of feed, mm/min.
    retract : float, optional
        Z of rapids between cuts. Default: 5 above `top`, mm.
    clearance : float
        Above material, where rapids downwards end, mm.
    allowance : float
        Left on walls for a finishing pass, mm.
    direction : {'climb', 'conventional'}
        Direction along walls, of a clockwise spindle.
    entry : {'helix', 'ramp', 'plunge'}
        How the tool enters the material.
    entry_angle : float
        Maximum descent of a ramp or helix, degrees.
    helix_radius : float
        Radius of a helix, of the tool's axis; 0: 0.45 times the diameter, mm.
    pattern : {'offset', 'spiral', 'zigzag', 'adaptive'}
        Paths of a pocket.
    engagement : float
        Maximum engagement angle of an adaptive pocket or trochoidal slot, degrees.
    angle : float
        Direction of the lines of a zigzag or of facing, from +X, degrees.
    finish : float
        Left on walls, and removed by a last pass at the full depth, mm.
    rest_tool : Tool or str, optional
        The tool of the same operation before: only what it left is cut.
    rpm : float
        Spindle speed, clockwise; 0: none, rpm.
    name : str
        Name of the operation, in messages and in the program.

    Returns
    -------
    Program

    Raises
    ------
    kerf.Error
        If a value is out of range, or the tool fits nowhere. Parts that are too narrow for it are
        warnings.
    """
    return _run(
        "pocket",
        shapes=region,
        tool=tool,
        depth=depth,
        top=top,
        stepdown=stepdown,
        stepover=stepover,
        feed=feed,
        material=material,
        machine=machine,
        plunge=plunge,
        retract=retract,
        clearance=clearance,
        allowance=allowance,
        direction=direction,
        entry=entry,
        entry_angle=entry_angle,
        helix_radius=helix_radius,
        pattern=pattern,
        engagement=engagement,
        angle=angle,
        finish=finish,
        rest_tool=rest_tool,
        rpm=rpm or None,
        name=name or None,
    )


def contour(
    region,
    tool,
    *,
    depth,
    top=0.0,
    stepdown=0.0,
    feed=None,
    material=None,
    machine=None,
    plunge=0.0,
    retract=None,
    clearance=0.5,
    allowance=0.0,
    direction="climb",
    entry="ramp",
    entry_angle=3.0,
    helix_radius=0.0,
    side="outside",
    finish=0.0,
    lead=0.0,
    lead_out=None,
    lead_kind="arc",
    overlap=0.0,
    tab_height=0.0,
    tab_length=0.0,
    tabs=4,
    tab_spacing=0.0,
    tab_shape="rectangular",
    rpm=0.0,
    name="",
):
    """Cut along the boundary of a region.

    Parameters
    ----------
    region : Region or list of outlines
        The part (side 'outside': around it and inside its holes) or the opening ('inside'), mm.
    tool : Tool, str or int
        Such as ``'square d=6'``; its number in the program is that of the Tool, else 1.
    depth : float
        Below the surface, mm.
    top : float
        Z of the surface of the material, mm.
    stepdown : float
        Maximum depth of a pass; 0: one pass, mm.
    feed : float, optional
        Feed of cuts. Without it, the chip load in `material` gives it, mm/min.
    material : str, optional
        For a feed that is not given, such as 'MDF' or 'aluminium'.
    machine : str, optional
        File of the machine whose limits a chosen feed keeps.
    plunge : float
        Maximum feed downwards; 0: half of feed, mm/min.
    retract : float, optional
        Z of rapids between cuts. Default: 5 above `top`, mm.
    clearance : float
        Above material, where rapids downwards end, mm.
    allowance : float
        Left on walls for a finishing pass, mm.
    direction : {'climb', 'conventional'}
        Direction along walls, of a clockwise spindle.
    entry : {'helix', 'ramp', 'plunge'}
        How the tool enters the material.
    entry_angle : float
        Maximum descent of a ramp or helix, degrees.
    helix_radius : float
        Radius of a helix, of the tool's axis; 0: 0.45 times the diameter, mm.
    side : {'outside', 'inside'}
        Side of the outlines that a contour is cut on.
    finish : float
        Left on walls, and removed by a last pass at the full depth, mm.
    lead : float
        Radius or length of the lead-in and lead-out of a contour; 0: none, mm.
    lead_out : float, optional
        Size of the lead-out. Default: as `lead`, mm.
    lead_kind : {'arc', 'line'}
        Arcs tangent to the wall, or lines square to it.
    overlap : float
        How far a contour continues beyond its start, mm.
    tab_height : float
        Height of tabs above the bottom; 0: no tabs, mm.
    tab_length : float
        Length of tabs; 0: the diameter of the tool, mm.
    tabs : int
        Number of tabs on each contour.
    tab_spacing : float
        Distance of tabs; 0: by their number, mm.
    tab_shape : {'rectangular', 'triangular'}
        Shape of tabs.
    rpm : float
        Spindle speed, clockwise; 0: none, rpm.
    name : str
        Name of the operation, in messages and in the program.

    Returns
    -------
    Program

    Raises
    ------
    kerf.Error
        If a value is out of range, or the tool fits nowhere. Parts that are too narrow for it are
        warnings.
    """
    return _run(
        "contour",
        shapes=region,
        tool=tool,
        depth=depth,
        top=top,
        stepdown=stepdown,
        feed=feed,
        material=material,
        machine=machine,
        plunge=plunge,
        retract=retract,
        clearance=clearance,
        allowance=allowance,
        direction=direction,
        entry=entry,
        entry_angle=entry_angle,
        helix_radius=helix_radius,
        side=side,
        finish=finish,
        lead=lead,
        lead_out=lead_out,
        lead_kind=lead_kind,
        overlap=overlap,
        tab_height=tab_height,
        tab_length=tab_length,
        tabs=tabs,
        tab_spacing=tab_spacing,
        tab_shape=tab_shape,
        rpm=rpm or None,
        name=name or None,
    )


def engrave(
    outlines,
    tool,
    *,
    depth,
    top=0.0,
    stepdown=0.0,
    feed=None,
    material=None,
    machine=None,
    plunge=0.0,
    retract=None,
    clearance=0.5,
    entry="ramp",
    entry_angle=3.0,
    helix_radius=0.0,
    rpm=0.0,
    name="",
):
    """Cut along outlines, open or closed, with the axis of the tool.

    Parameters
    ----------
    outlines : Region or list of outlines
        Lists of points and arcs as in `Region`, mm; `text_outlines` makes those of texts.
    tool : Tool, str or int
        Such as ``'square d=6'``; its number in the program is that of the Tool, else 1.
    depth : float
        Below the surface, mm.
    top : float
        Z of the surface of the material, mm.
    stepdown : float
        Maximum depth of a pass; 0: one pass, mm.
    feed : float, optional
        Feed of cuts. Without it, the chip load in `material` gives it, mm/min.
    material : str, optional
        For a feed that is not given, such as 'MDF' or 'aluminium'.
    machine : str, optional
        File of the machine whose limits a chosen feed keeps.
    plunge : float
        Maximum feed downwards; 0: half of feed, mm/min.
    retract : float, optional
        Z of rapids between cuts. Default: 5 above `top`, mm.
    clearance : float
        Above material, where rapids downwards end, mm.
    entry : {'helix', 'ramp', 'plunge'}
        How the tool enters the material.
    entry_angle : float
        Maximum descent of a ramp or helix, degrees.
    helix_radius : float
        Radius of a helix, of the tool's axis; 0: 0.45 times the diameter, mm.
    rpm : float
        Spindle speed, clockwise; 0: none, rpm.
    name : str
        Name of the operation, in messages and in the program.

    Returns
    -------
    Program

    Raises
    ------
    kerf.Error
        If a value is out of range, or the tool fits nowhere. Parts that are too narrow for it are
        warnings.
    """
    return _run(
        "engrave",
        shapes=outlines,
        tool=tool,
        depth=depth,
        top=top,
        stepdown=stepdown,
        feed=feed,
        material=material,
        machine=machine,
        plunge=plunge,
        retract=retract,
        clearance=clearance,
        entry=entry,
        entry_angle=entry_angle,
        helix_radius=helix_radius,
        rpm=rpm or None,
        name=name or None,
    )


def face(
    region,
    tool,
    *,
    depth,
    top=0.0,
    stepdown=0.0,
    stepover=0.4,
    feed=None,
    material=None,
    machine=None,
    plunge=0.0,
    retract=None,
    clearance=0.5,
    entry="helix",
    entry_angle=3.0,
    helix_radius=0.0,
    angle=0.0,
    rpm=0.0,
    name="",
):
    """Cut all above a region with parallel lines that leave it on all sides.

    Parameters
    ----------
    region : Region or list of outlines
        The surface, mm.
    tool : Tool, str or int
        Such as ``'square d=6'``; its number in the program is that of the Tool, else 1.
    depth : float
        Below the surface, mm.
    top : float
        Z of the surface of the material, mm.
    stepdown : float
        Maximum depth of a pass; 0: one pass, mm.
    stepover : float
        Distance of paths as a fraction of the diameter of the tool.
    feed : float, optional
        Feed of cuts. Without it, the chip load in `material` gives it, mm/min.
    material : str, optional
        For a feed that is not given, such as 'MDF' or 'aluminium'.
    machine : str, optional
        File of the machine whose limits a chosen feed keeps.
    plunge : float
        Maximum feed downwards; 0: half of feed, mm/min.
    retract : float, optional
        Z of rapids between cuts. Default: 5 above `top`, mm.
    clearance : float
        Above material, where rapids downwards end, mm.
    entry : {'helix', 'ramp', 'plunge'}
        How the tool enters the material.
    entry_angle : float
        Maximum descent of a ramp or helix, degrees.
    helix_radius : float
        Radius of a helix, of the tool's axis; 0: 0.45 times the diameter, mm.
    angle : float
        Direction of the lines of a zigzag or of facing, from +X, degrees.
    rpm : float
        Spindle speed, clockwise; 0: none, rpm.
    name : str
        Name of the operation, in messages and in the program.

    Returns
    -------
    Program

    Raises
    ------
    kerf.Error
        If a value is out of range, or the tool fits nowhere. Parts that are too narrow for it are
        warnings.
    """
    return _run(
        "face",
        shapes=region,
        tool=tool,
        depth=depth,
        top=top,
        stepdown=stepdown,
        stepover=stepover,
        feed=feed,
        material=material,
        machine=machine,
        plunge=plunge,
        retract=retract,
        clearance=clearance,
        entry=entry,
        entry_angle=entry_angle,
        helix_radius=helix_radius,
        angle=angle,
        rpm=rpm or None,
        name=name or None,
    )


def drill(
    points,
    tool,
    *,
    depth,
    top=0.0,
    feed=None,
    material=None,
    machine=None,
    retract=None,
    clearance=0.5,
    cycle="plain",
    peck=0.0,
    dwell=0.0,
    rpm=0.0,
    name="",
):
    """Drill holes.

    Parameters
    ----------
    points : list of (float, float)
        Centres of the holes, mm.
    tool : Tool, str or int
        Such as ``'square d=6'``; its number in the program is that of the Tool, else 1.
    depth : float
        Below the surface, mm.
    top : float
        Z of the surface of the material, mm.
    feed : float, optional
        Feed of cuts. Without it, the chip load in `material` gives it, mm/min.
    material : str, optional
        For a feed that is not given, such as 'MDF' or 'aluminium'.
    machine : str, optional
        File of the machine whose limits a chosen feed keeps.
    retract : float, optional
        Z of rapids between cuts. Default: 5 above `top`, mm.
    clearance : float
        Above material, where rapids downwards end, mm.
    cycle : {'plain', 'dwell', 'peck', 'chip-break', 'bore', 'dwell-bore'}
        Cycle of drilled holes.
    peck : float
        Depth of a peck, mm.
    dwell : float
        At the bottom of a drilled hole, s.
    rpm : float
        Spindle speed, clockwise; 0: none, rpm.
    name : str
        Name of the operation, in messages and in the program.

    Returns
    -------
    Program

    Raises
    ------
    kerf.Error
        If a value is out of range, or the tool fits nowhere. Parts that are too narrow for it are
        warnings.
    """
    return _run(
        "drill",
        points=points,
        tool=tool,
        depth=depth,
        top=top,
        feed=feed,
        material=material,
        machine=machine,
        retract=retract,
        clearance=clearance,
        cycle=cycle,
        peck=peck,
        dwell=dwell,
        rpm=rpm or None,
        name=name or None,
    )


def bore(
    circles,
    tool,
    *,
    depth,
    top=0.0,
    stepdown=0.0,
    stepover=0.4,
    feed=None,
    material=None,
    machine=None,
    plunge=0.0,
    retract=None,
    clearance=0.5,
    allowance=0.0,
    direction="climb",
    entry_angle=3.0,
    rpm=0.0,
    name="",
):
    """Mill round holes by helices.

    Parameters
    ----------
    circles : list of (float, float, float)
        The holes: x, y and radius, mm.
    tool : Tool, str or int
        Such as ``'square d=6'``; its number in the program is that of the Tool, else 1.
    depth : float
        Below the surface, mm.
    top : float
        Z of the surface of the material, mm.
    stepdown : float
        Maximum depth of a pass; 0: one pass, mm.
    stepover : float
        Distance of paths as a fraction of the diameter of the tool.
    feed : float, optional
        Feed of cuts. Without it, the chip load in `material` gives it, mm/min.
    material : str, optional
        For a feed that is not given, such as 'MDF' or 'aluminium'.
    machine : str, optional
        File of the machine whose limits a chosen feed keeps.
    plunge : float
        Maximum feed downwards; 0: half of feed, mm/min.
    retract : float, optional
        Z of rapids between cuts. Default: 5 above `top`, mm.
    clearance : float
        Above material, where rapids downwards end, mm.
    allowance : float
        Left on walls for a finishing pass, mm.
    direction : {'climb', 'conventional'}
        Direction along walls, of a clockwise spindle.
    entry_angle : float
        Maximum descent of a ramp or helix, degrees.
    rpm : float
        Spindle speed, clockwise; 0: none, rpm.
    name : str
        Name of the operation, in messages and in the program.

    Returns
    -------
    Program

    Raises
    ------
    kerf.Error
        If a value is out of range, or the tool fits nowhere. Parts that are too narrow for it are
        warnings.
    """
    return _run(
        "bore",
        shapes=circles,
        tool=tool,
        depth=depth,
        top=top,
        stepdown=stepdown,
        stepover=stepover,
        feed=feed,
        material=material,
        machine=machine,
        plunge=plunge,
        retract=retract,
        clearance=clearance,
        allowance=allowance,
        direction=direction,
        entry_angle=entry_angle,
        rpm=rpm or None,
        name=name or None,
    )


def keyhole(
    points,
    tool,
    *,
    depth,
    length,
    top=0.0,
    feed=None,
    material=None,
    machine=None,
    plunge=0.0,
    retract=None,
    clearance=0.5,
    direction="climb",
    angle=0.0,
    slot_clearance=0.0,
    rpm=0.0,
    name="",
):
    """Cut keyholes: down, along a slot, back, and up.

    Parameters
    ----------
    points : list of (float, float)
        Where the tool goes down, mm.
    tool : Tool, str or int
        Such as ``'square d=6'``; its number in the program is that of the Tool, else 1.
    depth : float
        Below the surface, mm.
    length : float
        Length of a keyhole, from its entry in the direction of angle, mm.
    top : float
        Z of the surface of the material, mm.
    feed : float, optional
        Feed of cuts. Without it, the chip load in `material` gives it, mm/min.
    material : str, optional
        For a feed that is not given, such as 'MDF' or 'aluminium'.
    machine : str, optional
        File of the machine whose limits a chosen feed keeps.
    plunge : float
        Maximum feed downwards; 0: half of feed, mm/min.
    retract : float, optional
        Z of rapids between cuts. Default: 5 above `top`, mm.
    clearance : float
        Above material, where rapids downwards end, mm.
    direction : {'climb', 'conventional'}
        Direction along walls, of a clockwise spindle.
    angle : float
        Direction of the lines of a zigzag or of facing, from +X, degrees.
    slot_clearance : float
        By which a keyhole is wider than its tool, mm.
    rpm : float
        Spindle speed, clockwise; 0: none, rpm.
    name : str
        Name of the operation, in messages and in the program.

    Returns
    -------
    Program

    Raises
    ------
    kerf.Error
        If a value is out of range, or the tool fits nowhere. Parts that are too narrow for it are
        warnings.
    """
    return _run(
        "keyhole",
        points=points,
        tool=tool,
        depth=depth,
        length=length,
        top=top,
        feed=feed,
        material=material,
        machine=machine,
        plunge=plunge,
        retract=retract,
        clearance=clearance,
        direction=direction,
        angle=angle,
        slot_clearance=slot_clearance,
        rpm=rpm or None,
        name=name or None,
    )


def slot(
    outlines,
    tool,
    *,
    depth,
    top=0.0,
    stepover=0.4,
    feed=None,
    material=None,
    machine=None,
    plunge=0.0,
    retract=None,
    clearance=0.5,
    direction="climb",
    width=0.0,
    rpm=0.0,
    name="",
):
    """Cut slots between edges of the material, with dovetail or T-slot tools.

    Parameters
    ----------
    outlines : Region or list of outlines
        Open outlines from edge to edge, mm; the tool goes down and up outside.
    tool : Tool, str or int
        Such as ``'square d=6'``; its number in the program is that of the Tool, else 1.
    depth : float
        Below the surface, mm.
    top : float
        Z of the surface of the material, mm.
    stepover : float
        Distance of paths as a fraction of the diameter of the tool.
    feed : float, optional
        Feed of cuts. Without it, the chip load in `material` gives it, mm/min.
    material : str, optional
        For a feed that is not given, such as 'MDF' or 'aluminium'.
    machine : str, optional
        File of the machine whose limits a chosen feed keeps.
    plunge : float
        Maximum feed downwards; 0: half of feed, mm/min.
    retract : float, optional
        Z of rapids between cuts. Default: 5 above `top`, mm.
    clearance : float
        Above material, where rapids downwards end, mm.
    direction : {'climb', 'conventional'}
        Direction along walls, of a clockwise spindle.
    width : float
        Width of a slot where the tool is widest, 0: the diameter; of a trochoidal slot, mm.
    rpm : float
        Spindle speed, clockwise; 0: none, rpm.
    name : str
        Name of the operation, in messages and in the program.

    Returns
    -------
    Program

    Raises
    ------
    kerf.Error
        If a value is out of range, or the tool fits nowhere. Parts that are too narrow for it are
        warnings.
    """
    return _run(
        "slot",
        shapes=outlines,
        tool=tool,
        depth=depth,
        top=top,
        stepover=stepover,
        feed=feed,
        material=material,
        machine=machine,
        plunge=plunge,
        retract=retract,
        clearance=clearance,
        direction=direction,
        width=width,
        rpm=rpm or None,
        name=name or None,
    )


def trochoidal_slot(
    outlines,
    tool,
    *,
    depth,
    width,
    top=0.0,
    stepdown=0.0,
    stepover=0.4,
    feed=None,
    material=None,
    machine=None,
    plunge=0.0,
    retract=None,
    clearance=0.5,
    direction="climb",
    entry_angle=3.0,
    engagement=60.0,
    rpm=0.0,
    name="",
):
    """Cut slots wider than the tool along outlines, by loops within a limit of the engagement angle.

    Parameters
    ----------
    outlines : Region or list of outlines
        Centre lines of the slots, open or closed, mm.
    tool : Tool, str or int
        Such as ``'square d=6'``; its number in the program is that of the Tool, else 1.
    depth : float
        Below the surface, mm.
    width : float
        Width of a slot where the tool is widest, 0: the diameter; of a trochoidal slot, mm.
    top : float
        Z of the surface of the material, mm.
    stepdown : float
        Maximum depth of a pass; 0: one pass, mm.
    stepover : float
        Distance of paths as a fraction of the diameter of the tool.
    feed : float, optional
        Feed of cuts. Without it, the chip load in `material` gives it, mm/min.
    material : str, optional
        For a feed that is not given, such as 'MDF' or 'aluminium'.
    machine : str, optional
        File of the machine whose limits a chosen feed keeps.
    plunge : float
        Maximum feed downwards; 0: half of feed, mm/min.
    retract : float, optional
        Z of rapids between cuts. Default: 5 above `top`, mm.
    clearance : float
        Above material, where rapids downwards end, mm.
    direction : {'climb', 'conventional'}
        Direction along walls, of a clockwise spindle.
    entry_angle : float
        Maximum descent of a ramp or helix, degrees.
    engagement : float
        Maximum engagement angle of an adaptive pocket or trochoidal slot, degrees.
    rpm : float
        Spindle speed, clockwise; 0: none, rpm.
    name : str
        Name of the operation, in messages and in the program.

    Returns
    -------
    Program

    Raises
    ------
    kerf.Error
        If a value is out of range, or the tool fits nowhere. Parts that are too narrow for it are
        warnings.
    """
    return _run(
        "trochoidal-slot",
        shapes=outlines,
        tool=tool,
        depth=depth,
        width=width,
        top=top,
        stepdown=stepdown,
        stepover=stepover,
        feed=feed,
        material=material,
        machine=machine,
        plunge=plunge,
        retract=retract,
        clearance=clearance,
        direction=direction,
        entry_angle=entry_angle,
        engagement=engagement,
        rpm=rpm or None,
        name=name or None,
    )


def thread(
    circles,
    tool,
    *,
    depth,
    pitch,
    top=0.0,
    feed=None,
    material=None,
    machine=None,
    plunge=0.0,
    retract=None,
    clearance=0.5,
    direction="climb",
    side="inside",
    hand="right",
    thread_passes=1,
    thread_teeth=1,
    rpm=0.0,
    name="",
):
    """Cut threads with a thread mill. The hole or rod must be there.

    Parameters
    ----------
    circles : list of (float, float, float)
        Major diameters: x, y and radius, mm.
    tool : Tool, str or int
        Such as ``'square d=6'``; its number in the program is that of the Tool, else 1.
    depth : float
        Below the surface, mm.
    pitch : float
        Pitch of a thread, mm.
    top : float
        Z of the surface of the material, mm.
    feed : float, optional
        Feed of cuts. Without it, the chip load in `material` gives it, mm/min.
    material : str, optional
        For a feed that is not given, such as 'MDF' or 'aluminium'.
    machine : str, optional
        File of the machine whose limits a chosen feed keeps.
    plunge : float
        Maximum feed downwards; 0: half of feed, mm/min.
    retract : float, optional
        Z of rapids between cuts. Default: 5 above `top`, mm.
    clearance : float
        Above material, where rapids downwards end, mm.
    direction : {'climb', 'conventional'}
        Direction along walls, of a clockwise spindle.
    side : {'outside', 'inside'}
        Side of the outlines that a contour is cut on.
    hand : {'right', 'left'}
        Hand of a thread.
    thread_passes : int
        Number of passes of a thread, deeper each time.
    thread_teeth : int
        Number of teeth of the thread mill, one pitch apart.
    rpm : float
        Spindle speed, clockwise; 0: none, rpm.
    name : str
        Name of the operation, in messages and in the program.

    Returns
    -------
    Program

    Raises
    ------
    kerf.Error
        If a value is out of range, or the tool fits nowhere. Parts that are too narrow for it are
        warnings.
    """
    return _run(
        "thread",
        shapes=circles,
        tool=tool,
        depth=depth,
        pitch=pitch,
        top=top,
        feed=feed,
        material=material,
        machine=machine,
        plunge=plunge,
        retract=retract,
        clearance=clearance,
        direction=direction,
        side=side,
        hand=hand,
        thread_passes=thread_passes,
        thread_teeth=thread_teeth,
        rpm=rpm or None,
        name=name or None,
    )


def countersink(
    circles,
    tool,
    *,
    depth,
    top=0.0,
    feed=None,
    material=None,
    machine=None,
    plunge=0.0,
    retract=None,
    clearance=0.5,
    direction="climb",
    cone_angle=90.0,
    rpm=0.0,
    name="",
):
    """Cut cones from circles down to a depth, with a ball mill.

    Parameters
    ----------
    circles : list of (float, float, float)
        The circles at the surface: x, y and radius, mm.
    tool : Tool, str or int
        Such as ``'square d=6'``; its number in the program is that of the Tool, else 1.
    depth : float
        Below the surface, mm.
    top : float
        Z of the surface of the material, mm.
    feed : float, optional
        Feed of cuts. Without it, the chip load in `material` gives it, mm/min.
    material : str, optional
        For a feed that is not given, such as 'MDF' or 'aluminium'.
    machine : str, optional
        File of the machine whose limits a chosen feed keeps.
    plunge : float
        Maximum feed downwards; 0: half of feed, mm/min.
    retract : float, optional
        Z of rapids between cuts. Default: 5 above `top`, mm.
    clearance : float
        Above material, where rapids downwards end, mm.
    direction : {'climb', 'conventional'}
        Direction along walls, of a clockwise spindle.
    cone_angle : float
        Angle of a countersink between its sides, degrees.
    rpm : float
        Spindle speed, clockwise; 0: none, rpm.
    name : str
        Name of the operation, in messages and in the program.

    Returns
    -------
    Program

    Raises
    ------
    kerf.Error
        If a value is out of range, or the tool fits nowhere. Parts that are too narrow for it are
        warnings.
    """
    return _run(
        "countersink",
        shapes=circles,
        tool=tool,
        depth=depth,
        top=top,
        feed=feed,
        material=material,
        machine=machine,
        plunge=plunge,
        retract=retract,
        clearance=clearance,
        direction=direction,
        cone_angle=cone_angle,
        rpm=rpm or None,
        name=name or None,
    )


def v_carve(
    region,
    tool,
    *,
    top=0.0,
    depth=None,
    stepdown=0.0,
    feed=None,
    material=None,
    machine=None,
    plunge=0.0,
    retract=None,
    clearance=0.5,
    direction="climb",
    entry="ramp",
    entry_angle=3.0,
    helix_radius=0.0,
    part="pocket",
    glue_gap=0.0,
    base_gap=0.0,
    margin=0.0,
    rpm=0.0,
    name="",
):
    """Carve a region with a V tool: its edges at the surface are exactly those of the region.

    Parameters
    ----------
    region : Region or list of outlines
        What is carved; with part 'plug' what fits into it, mirrored. mm.
    tool : Tool, str or int
        Such as ``'square d=6'``; its number in the program is that of the Tool, else 1.
    top : float
        Z of the surface of the material, mm.
    depth : float, optional
        Below the surface. Default: as deep as the outlines or the cone of the tool permit, mm.
    stepdown : float
        Maximum depth of a pass; 0: one pass, mm.
    feed : float, optional
        Feed of cuts. Without it, the chip load in `material` gives it, mm/min.
    material : str, optional
        For a feed that is not given, such as 'MDF' or 'aluminium'.
    machine : str, optional
        File of the machine whose limits a chosen feed keeps.
    plunge : float
        Maximum feed downwards; 0: half of feed, mm/min.
    retract : float, optional
        Z of rapids between cuts. Default: 5 above `top`, mm.
    clearance : float
        Above material, where rapids downwards end, mm.
    direction : {'climb', 'conventional'}
        Direction along walls, of a clockwise spindle.
    entry : {'helix', 'ramp', 'plunge'}
        How the tool enters the material.
    entry_angle : float
        Maximum descent of a ramp or helix, degrees.
    helix_radius : float
        Radius of a helix, of the tool's axis; 0: 0.45 times the diameter, mm.
    part : {'pocket', 'plug'}
        Part of an inlay: what is carved, or what fits into it, mirrored.
    glue_gap : float
        Between the face of a plug and the floor of its pocket, mm.
    base_gap : float
        Between the surfaces around a plug and around its pocket, mm.
    margin : float
        Width of the floor around a plug; 0: twice the diameter, mm.
    rpm : float
        Spindle speed, clockwise; 0: none, rpm.
    name : str
        Name of the operation, in messages and in the program.

    Returns
    -------
    Program

    Raises
    ------
    kerf.Error
        If a value is out of range, or the tool fits nowhere. Parts that are too narrow for it are
        warnings.
    """
    return _run(
        "vcarve",
        shapes=region,
        tool=tool,
        top=top,
        depth=depth,
        stepdown=stepdown,
        feed=feed,
        material=material,
        machine=machine,
        plunge=plunge,
        retract=retract,
        clearance=clearance,
        direction=direction,
        entry=entry,
        entry_angle=entry_angle,
        helix_radius=helix_radius,
        part=part,
        glue_gap=glue_gap,
        base_gap=base_gap,
        margin=margin,
        rpm=rpm or None,
        name=name or None,
    )


def v_carve_floor(
    region,
    tool,
    *,
    depth,
    carve_tool,
    top=0.0,
    stepdown=0.0,
    stepover=0.4,
    feed=None,
    material=None,
    machine=None,
    plunge=0.0,
    retract=None,
    clearance=0.5,
    allowance=0.0,
    direction="climb",
    entry="helix",
    entry_angle=3.0,
    helix_radius=0.0,
    pattern="offset",
    engagement=60.0,
    angle=0.0,
    finish=0.0,
    part="pocket",
    glue_gap=0.0,
    base_gap=0.0,
    margin=0.0,
    rest_tool=None,
    rpm=0.0,
    name="",
):
    """Clear the flat floor that `v_carve` leaves.

    Parameters
    ----------
    region : Region or list of outlines
        As of `v_carve`.
    tool : Tool, str or int
        Such as ``'square d=6'``; its number in the program is that of the Tool, else 1.
    depth : float
        Below the surface, mm.
    carve_tool : Tool or str
        The tool of the `vcarve` that leaves this floor.
    top : float
        Z of the surface of the material, mm.
    stepdown : float
        Maximum depth of a pass; 0: one pass, mm.
    stepover : float
        Distance of paths as a fraction of the diameter of the tool.
    feed : float, optional
        Feed of cuts. Without it, the chip load in `material` gives it, mm/min.
    material : str, optional
        For a feed that is not given, such as 'MDF' or 'aluminium'.
    machine : str, optional
        File of the machine whose limits a chosen feed keeps.
    plunge : float
        Maximum feed downwards; 0: half of feed, mm/min.
    retract : float, optional
        Z of rapids between cuts. Default: 5 above `top`, mm.
    clearance : float
        Above material, where rapids downwards end, mm.
    allowance : float
        Left on walls for a finishing pass, mm.
    direction : {'climb', 'conventional'}
        Direction along walls, of a clockwise spindle.
    entry : {'helix', 'ramp', 'plunge'}
        How the tool enters the material.
    entry_angle : float
        Maximum descent of a ramp or helix, degrees.
    helix_radius : float
        Radius of a helix, of the tool's axis; 0: 0.45 times the diameter, mm.
    pattern : {'offset', 'spiral', 'zigzag', 'adaptive'}
        Paths of a pocket.
    engagement : float
        Maximum engagement angle of an adaptive pocket or trochoidal slot, degrees.
    angle : float
        Direction of the lines of a zigzag or of facing, from +X, degrees.
    finish : float
        Left on walls, and removed by a last pass at the full depth, mm.
    part : {'pocket', 'plug'}
        Part of an inlay: what is carved, or what fits into it, mirrored.
    glue_gap : float
        Between the face of a plug and the floor of its pocket, mm.
    base_gap : float
        Between the surfaces around a plug and around its pocket, mm.
    margin : float
        Width of the floor around a plug; 0: twice the diameter, mm.
    rest_tool : Tool or str, optional
        The tool of the same operation before: only what it left is cut.
    rpm : float
        Spindle speed, clockwise; 0: none, rpm.
    name : str
        Name of the operation, in messages and in the program.

    Returns
    -------
    Program

    Raises
    ------
    kerf.Error
        If a value is out of range, or the tool fits nowhere. Parts that are too narrow for it are
        warnings.
    """
    return _run(
        "vcarve-floor",
        shapes=region,
        tool=tool,
        depth=depth,
        carve_tool=carve_tool,
        top=top,
        stepdown=stepdown,
        stepover=stepover,
        feed=feed,
        material=material,
        machine=machine,
        plunge=plunge,
        retract=retract,
        clearance=clearance,
        allowance=allowance,
        direction=direction,
        entry=entry,
        entry_angle=entry_angle,
        helix_radius=helix_radius,
        pattern=pattern,
        engagement=engagement,
        angle=angle,
        finish=finish,
        part=part,
        glue_gap=glue_gap,
        base_gap=base_gap,
        margin=margin,
        rest_tool=rest_tool,
        rpm=rpm or None,
        name=name or None,
    )


def raster(
    mesh,
    tool,
    *,
    top=None,
    depth=None,
    stepdown=0.0,
    stepover=0.1,
    feed=None,
    material=None,
    machine=None,
    plunge=0.0,
    retract=None,
    clearance=0.5,
    allowance=0.0,
    angle=0.0,
    rest_tool=None,
    line_distance=0.0,
    overhang=0.0,
    rest_thickness=0.1,
    tolerance=0.01,
    area=None,
    move=(0, 0, 0),
    scale=1.0,
    rpm=0.0,
    name="",
):
    """Cut a mesh in parallel lines.

    Parameters
    ----------
    mesh : str, os.PathLike or (points, triangles)
        A file (.stl, .3mf, .obj), or arrays of points, N x 3, mm, and of the indices of the corners of
        triangles, M x 3; `Simulation.mesh` returns such.
    tool : Tool, str or int
        Such as ``'square d=6'``; its number in the program is that of the Tool, else 1.
    top : float, optional
        Z of the surface of the material. Default: the highest point of the mesh, mm.
    depth : float, optional
        Below the surface. Default: down to the lowest point of the mesh, mm.
    stepdown : float
        Maximum depth of a pass; 0: one pass, mm.
    stepover : float
        Distance of paths as a fraction of the diameter of the tool.
    feed : float, optional
        Feed of cuts. Without it, the chip load in `material` gives it, mm/min.
    material : str, optional
        For a feed that is not given, such as 'MDF' or 'aluminium'.
    machine : str, optional
        File of the machine whose limits a chosen feed keeps.
    plunge : float
        Maximum feed downwards; 0: half of feed, mm/min.
    retract : float, optional
        Z of rapids between cuts. Default: 5 above `top`, mm.
    clearance : float
        Above material, where rapids downwards end, mm.
    allowance : float
        Left on walls for a finishing pass, mm.
    angle : float
        Direction of the lines of a zigzag or of facing, from +X, degrees.
    rest_tool : Tool or str, optional
        The tool of the same operation before: only what it left is cut.
    line_distance : float
        Distance of the lines of a raster; 0: by stepover, mm.
    overhang : float
        How far the axis goes beyond the mesh where no area is selected, mm.
    rest_thickness : float
        Thickness of what rest-tool left: what is thinner is not cut, mm.
    tolerance : float
        How far above a mesh the path may be, mm.
    area : Region or list of outlines, optional
        Where the axis of the tool stays. Default: the rectangle around the mesh, wider by `overhang`.
    move : (float, float, float)
        By which the mesh is moved, mm.
    scale : float
        Factor of the mesh about its origin, before it is moved.
    rpm : float
        Spindle speed, clockwise; 0: none, rpm.
    name : str
        Name of the operation, in messages and in the program.

    Returns
    -------
    Program

    Raises
    ------
    kerf.Error
        If a value is out of range, or the tool fits nowhere. Parts that are too narrow for it are
        warnings.
    """
    return _run(
        "raster",
        mesh=mesh,
        move=move,
        scale=scale,
        shapes=area,
        tool=tool,
        top=top,
        depth=depth,
        stepdown=stepdown,
        stepover=stepover,
        feed=feed,
        material=material,
        machine=machine,
        plunge=plunge,
        retract=retract,
        clearance=clearance,
        allowance=allowance,
        angle=angle,
        rest_tool=rest_tool,
        line_distance=line_distance,
        overhang=overhang,
        rest_thickness=rest_thickness,
        tolerance=tolerance,
        rpm=rpm or None,
        name=name or None,
    )


def waterline(
    mesh,
    tool,
    *,
    top=None,
    depth=None,
    stepdown=0.0,
    feed=None,
    material=None,
    machine=None,
    plunge=0.0,
    retract=None,
    clearance=0.5,
    allowance=0.0,
    direction="climb",
    rest_tool=None,
    rest_thickness=0.1,
    tolerance=0.01,
    move=(0, 0, 0),
    scale=1.0,
    rpm=0.0,
    name="",
):
    """Cut around a mesh on levels that are the stepdown apart.

    Parameters
    ----------
    mesh : str, os.PathLike or (points, triangles)
        A file (.stl, .3mf, .obj), or arrays of points, N x 3, mm, and of the indices of the corners of
        triangles, M x 3; `Simulation.mesh` returns such.
    tool : Tool, str or int
        Such as ``'square d=6'``; its number in the program is that of the Tool, else 1.
    top : float, optional
        Z of the surface of the material. Default: the highest point of the mesh, mm.
    depth : float, optional
        Below the surface. Default: down to the lowest point of the mesh, mm.
    stepdown : float
        Maximum depth of a pass; 0: one pass, mm.
    feed : float, optional
        Feed of cuts. Without it, the chip load in `material` gives it, mm/min.
    material : str, optional
        For a feed that is not given, such as 'MDF' or 'aluminium'.
    machine : str, optional
        File of the machine whose limits a chosen feed keeps.
    plunge : float
        Maximum feed downwards; 0: half of feed, mm/min.
    retract : float, optional
        Z of rapids between cuts. Default: 5 above `top`, mm.
    clearance : float
        Above material, where rapids downwards end, mm.
    allowance : float
        Left on walls for a finishing pass, mm.
    direction : {'climb', 'conventional'}
        Direction along walls, of a clockwise spindle.
    rest_tool : Tool or str, optional
        The tool of the same operation before: only what it left is cut.
    rest_thickness : float
        Thickness of what rest-tool left: what is thinner is not cut, mm.
    tolerance : float
        How far above a mesh the path may be, mm.
    move : (float, float, float)
        By which the mesh is moved, mm.
    scale : float
        Factor of the mesh about its origin, before it is moved.
    rpm : float
        Spindle speed, clockwise; 0: none, rpm.
    name : str
        Name of the operation, in messages and in the program.

    Returns
    -------
    Program

    Raises
    ------
    kerf.Error
        If a value is out of range, or the tool fits nowhere. Parts that are too narrow for it are
        warnings.
    """
    return _run(
        "waterline",
        mesh=mesh,
        move=move,
        scale=scale,
        tool=tool,
        top=top,
        depth=depth,
        stepdown=stepdown,
        feed=feed,
        material=material,
        machine=machine,
        plunge=plunge,
        retract=retract,
        clearance=clearance,
        allowance=allowance,
        direction=direction,
        rest_tool=rest_tool,
        rest_thickness=rest_thickness,
        tolerance=tolerance,
        rpm=rpm or None,
        name=name or None,
    )


def project(
    mesh,
    outlines,
    tool,
    *,
    depth,
    top=0.0,
    stepdown=0.0,
    feed=None,
    material=None,
    machine=None,
    plunge=0.0,
    retract=None,
    clearance=0.5,
    tolerance=0.01,
    move=(0, 0, 0),
    scale=1.0,
    rpm=0.0,
    name="",
):
    """Engrave outlines on a mesh, `depth` below where the tool touches it.

    Parameters
    ----------
    mesh : str, os.PathLike or (points, triangles)
        A file (.stl, .3mf, .obj), or arrays of points, N x 3, mm, and of the indices of the corners of
        triangles, M x 3; `Simulation.mesh` returns such.
    outlines : Region or list of outlines
        As of `engrave`.
    tool : Tool, str or int
        Such as ``'square d=6'``; its number in the program is that of the Tool, else 1.
    depth : float
        Below the surface, mm.
    top : float
        Z of the surface of the material, mm.
    stepdown : float
        Maximum depth of a pass; 0: one pass, mm.
    feed : float, optional
        Feed of cuts. Without it, the chip load in `material` gives it, mm/min.
    material : str, optional
        For a feed that is not given, such as 'MDF' or 'aluminium'.
    machine : str, optional
        File of the machine whose limits a chosen feed keeps.
    plunge : float
        Maximum feed downwards; 0: half of feed, mm/min.
    retract : float, optional
        Z of rapids between cuts. Default: 5 above `top`, mm.
    clearance : float
        Above material, where rapids downwards end, mm.
    tolerance : float
        How far above a mesh the path may be, mm.
    move : (float, float, float)
        By which the mesh is moved, mm.
    scale : float
        Factor of the mesh about its origin, before it is moved.
    rpm : float
        Spindle speed, clockwise; 0: none, rpm.
    name : str
        Name of the operation, in messages and in the program.

    Returns
    -------
    Program

    Raises
    ------
    kerf.Error
        If a value is out of range, or the tool fits nowhere. Parts that are too narrow for it are
        warnings.
    """
    return _run(
        "project",
        mesh=mesh,
        move=move,
        scale=scale,
        shapes=outlines,
        tool=tool,
        depth=depth,
        top=top,
        stepdown=stepdown,
        feed=feed,
        material=material,
        machine=machine,
        plunge=plunge,
        retract=retract,
        clearance=clearance,
        tolerance=tolerance,
        rpm=rpm or None,
        name=name or None,
    )


def laser(
    outlines,
    *,
    feed,
    power,
    max_s=1000.0,
    beam="dynamic",
    passes=1,
    name="",
):
    """Burn along outlines, open or closed.

    Parameters
    ----------
    outlines : Region or list of outlines
        Lists of points and arcs as in `Region`, mm.
    feed : float
        Feed of cuts; without it, it is chosen by the chip load in material, mm/min.
    power : float
        Power of the laser, %.
    max_s : float
        The S of full power, $30 in GRBL, S.
    beam : {'dynamic', 'constant'}
        M4, whose power follows the speed, or M3.
    passes : int
        Number of passes.
    name : str
        Name of the operation, in messages and in the program.

    Returns
    -------
    Program

    Raises
    ------
    kerf.Error
        If a value is out of range.
    """
    return _run(
        "laser",
        shapes=outlines,
        feed=feed,
        power=power,
        max_s=max_s,
        beam=beam,
        passes=passes,
        name=name or None,
    )


def laser_cut(
    region,
    *,
    feed,
    power,
    side="outside",
    lead=0.0,
    lead_out=None,
    lead_kind="arc",
    overlap=0.0,
    max_s=1000.0,
    beam="dynamic",
    passes=1,
    kerf=0.0,
    name="",
):
    """Cut a region out with a laser, half a kerf beside it.

    Parameters
    ----------
    region : Region or list of outlines
        As of `contour`.
    feed : float
        Feed of cuts; without it, it is chosen by the chip load in material, mm/min.
    power : float
        Power of the laser, %.
    side : {'outside', 'inside'}
        Side of the outlines that a contour is cut on.
    lead : float
        Radius or length of the lead-in and lead-out of a contour; 0: none, mm.
    lead_out : float, optional
        Size of the lead-out. Default: as `lead`, mm.
    lead_kind : {'arc', 'line'}
        Arcs tangent to the wall, or lines square to it.
    overlap : float
        How far a contour continues beyond its start, mm.
    max_s : float
        The S of full power, $30 in GRBL, S.
    beam : {'dynamic', 'constant'}
        M4, whose power follows the speed, or M3.
    passes : int
        Number of passes.
    kerf : float
        Width of the slot that the beam leaves, mm.
    name : str
        Name of the operation, in messages and in the program.

    Returns
    -------
    Program

    Raises
    ------
    kerf.Error
        If a value is out of range.
    """
    return _run(
        "laser-cut",
        shapes=region,
        feed=feed,
        power=power,
        side=side,
        lead=lead,
        lead_out=lead_out,
        lead_kind=lead_kind,
        overlap=overlap,
        max_s=max_s,
        beam=beam,
        passes=passes,
        kerf=kerf,
        name=name or None,
    )


def laser_fill(
    region,
    *,
    feed,
    power,
    angle=0.0,
    max_s=1000.0,
    beam="dynamic",
    passes=1,
    interval=0.1,
    overscan=2.0,
    scan="both",
    name="",
):
    """Burn all inside a region by parallel lines.

    Parameters
    ----------
    region : Region or list of outlines
        What is burnt, mm.
    feed : float
        Feed of cuts; without it, it is chosen by the chip load in material, mm/min.
    power : float
        Power of the laser, %.
    angle : float
        Direction of the lines of a zigzag or of facing, from +X, degrees.
    max_s : float
        The S of full power, $30 in GRBL, S.
    beam : {'dynamic', 'constant'}
        M4, whose power follows the speed, or M3.
    passes : int
        Number of passes.
    interval : float
        Distance of scan lines, and size of a picture's pixels, mm.
    overscan : float
        Length of scan lines beyond both ends, with power 0, mm.
    scan : {'both', 'one-way'}
        Directions of scan lines.
    name : str
        Name of the operation, in messages and in the program.

    Returns
    -------
    Program

    Raises
    ------
    kerf.Error
        If a value is out of range.
    """
    return _run(
        "laser-fill",
        shapes=region,
        feed=feed,
        power=power,
        angle=angle,
        max_s=max_s,
        beam=beam,
        passes=passes,
        interval=interval,
        overscan=overscan,
        scan=scan,
        name=name or None,
    )


def laser_picture(
    picture,
    *,
    feed,
    power,
    max_s=1000.0,
    beam="dynamic",
    passes=1,
    interval=0.1,
    overscan=2.0,
    scan="both",
    tones="grey",
    min_power=0.0,
    gamma=1.0,
    negative="no",
    width=0.0,
    at=(0, 0),
    name="",
):
    """Burn a picture by lines.

    Parameters
    ----------
    picture : str, os.PathLike or list of str
        A PNG file, or rows of digits from 0, white, to 9, black.
    feed : float
        Feed of cuts; without it, it is chosen by the chip load in material, mm/min.
    power : float
        Power of the laser, %.
    max_s : float
        The S of full power, $30 in GRBL, S.
    beam : {'dynamic', 'constant'}
        M4, whose power follows the speed, or M3.
    passes : int
        Number of passes.
    interval : float
        Distance of scan lines, and size of a picture's pixels, mm.
    overscan : float
        Length of scan lines beyond both ends, with power 0, mm.
    scan : {'both', 'one-way'}
        Directions of scan lines.
    tones : {'grey', 'dither'}
        Tones of a picture: power per pixel, or points at full power.
    min_power : float
        Power of the lightest tone of a picture that is not white, %.
    gamma : float
        Exponent of the darkness of a picture.
    negative : {'no', 'yes'}
        Picture in negative: white is burnt instead of black.
    width : float
        Width of the picture on the board; 0: by the resolution of its file, mm.
    at : (float, float)
        Its lower left corner, mm.
    name : str
        Name of the operation, in messages and in the program.

    Returns
    -------
    Program

    Raises
    ------
    kerf.Error
        If a value is out of range.
    """
    return _run(
        "laser-picture",
        picture=picture,
        feed=feed,
        power=power,
        max_s=max_s,
        beam=beam,
        passes=passes,
        interval=interval,
        overscan=overscan,
        scan=scan,
        tones=tones,
        min_power=min_power,
        gamma=gamma,
        negative=negative,
        picture_width=width,
        at=at,
        name=name or None,
    )


def laser_test(
    *,
    feed,
    power,
    max_s=1000.0,
    beam="dynamic",
    passes=1,
    interval=0.1,
    overscan=2.0,
    scan="both",
    rows=1,
    feed_to=0.0,
    columns=1,
    power_to=None,
    cell_width=10.0,
    cell_height=0.0,
    gap=4.0,
    label_height=0.0,
    name="",
):
    """Burn a grid of cells with increasing power and speed.

    Parameters
    ----------
    feed : float
        Feed of cuts; without it, it is chosen by the chip load in material, mm/min.
    power : float
        Power of the laser, %.
    max_s : float
        The S of full power, $30 in GRBL, S.
    beam : {'dynamic', 'constant'}
        M4, whose power follows the speed, or M3.
    passes : int
        Number of passes.
    interval : float
        Distance of scan lines, and size of a picture's pixels, mm.
    overscan : float
        Length of scan lines beyond both ends, with power 0, mm.
    scan : {'both', 'one-way'}
        Directions of scan lines.
    rows : int
        Rows of a test grid, from feed at the top to feed-to.
    feed_to : float
        Feed of the last row of a test grid; 0: as feed, mm/min.
    columns : int
        Columns of a test grid, from power on the left to power-to.
    power_to : float, optional
        Power of the last column of a test grid. Default: as `power`, %.
    cell_width : float
        Width of a cell of a test grid, mm.
    cell_height : float
        Height of a cell of a test grid; 0: a cell is one line, mm.
    gap : float
        Between the cells of a test grid, mm.
    label_height : float
        Height of the feeds and powers beside a test grid; 0: none, mm.
    name : str
        Name of the operation, in messages and in the program.

    Returns
    -------
    Program

    Raises
    ------
    kerf.Error
        If a value is out of range.
    """
    return _run(
        "laser-test",
        feed=feed,
        power=power,
        max_s=max_s,
        beam=beam,
        passes=passes,
        interval=interval,
        overscan=overscan,
        scan=scan,
        rows=rows,
        feed_to=feed_to,
        columns=columns,
        power_to=power_to,
        cell_width=cell_width,
        cell_height=cell_height,
        gap=gap,
        label_height=label_height,
        name=name or None,
    )


def laser_frame(
    outlines,
    *,
    feed,
    power=0.0,
    max_s=1000.0,
    beam="dynamic",
    passes=1,
    name="",
):
    """Move around shapes, to show where the work will be.

    Parameters
    ----------
    outlines : Region or list of outlines
        The shapes, mm.
    feed : float
        Feed of cuts; without it, it is chosen by the chip load in material, mm/min.
    power : float
        Power of the laser, %.
    max_s : float
        The S of full power, $30 in GRBL, S.
    beam : {'dynamic', 'constant'}
        M4, whose power follows the speed, or M3.
    passes : int
        Number of passes.
    name : str
        Name of the operation, in messages and in the program.

    Returns
    -------
    Program

    Raises
    ------
    kerf.Error
        If a value is out of range.
    """
    return _run(
        "laser-frame",
        shapes=outlines,
        feed=feed,
        power=power,
        max_s=max_s,
        beam=beam,
        passes=passes,
        name=name or None,
    )
